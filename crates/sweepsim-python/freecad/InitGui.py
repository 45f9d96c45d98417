"""Adds the command "Verify with sweepsim" to FreeCAD's CAM workbench."""

import FreeCADGui


class VerifyJob:
    """Verifies the selected job."""

    def GetResources(self):
        return {
            "MenuText": "Verify with sweepsim",
            "ToolTip": "Judges every move of the selected job, and lists those that do harm",
        }

    def IsActive(self):
        return self._job() is not None

    def Activated(self):
        import sweepsim_panel

        sweepsim_panel.show(self._job())

    @staticmethod
    def _job():
        chosen = [object for object in FreeCADGui.Selection.getSelection() if hasattr(object, "Operations")]
        return chosen[0] if chosen else None


class Manipulator:
    """Puts the command into the menu of the workbench."""

    def modifyMenuBar(self):
        names = "CAM_Simulator", "Path_Simulator"  # from 1.0 on, and before
        return [{"append": "Sweepsim_VerifyJob", "menuItem": name} for name in names]


def add_to_menu(workbench):
    """Does the same where FreeCAD is too old for manipulators: a menu bar is made anew whenever its workbench is shown."""
    import FreeCADGui
    from PySide import QtGui

    if workbench != "PathWorkbench":
        return
    window = FreeCADGui.getMainWindow()
    for menu in window.menuBar().actions():
        if menu.menu() and menu.text().replace("&", "") == "Path":
            action = QtGui.QAction("Verify with sweepsim", menu.menu())
            action.triggered.connect(lambda: FreeCADGui.runCommand("Sweepsim_VerifyJob"))
            menu.menu().addAction(action)


FreeCADGui.addCommand("Sweepsim_VerifyJob", VerifyJob())
if hasattr(FreeCADGui, "addWorkbenchManipulator"):
    FreeCADGui.addWorkbenchManipulator(Manipulator())
else:
    FreeCADGui.getMainWindow().workbenchActivated.connect(add_to_menu)
