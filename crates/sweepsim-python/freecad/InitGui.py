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
        return [{"append": "Sweepsim_VerifyJob", "menuItem": "Path_Simulator"}]


FreeCADGui.addCommand("Sweepsim_VerifyJob", VerifyJob())
FreeCADGui.addWorkbenchManipulator(Manipulator())
