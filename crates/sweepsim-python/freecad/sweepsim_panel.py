"""The findings of a job in a panel: a click selects the operation."""

import FreeCADGui
import sweepsim
import sweepsim_cam
from PySide import QtCore, QtGui


def show(job):
    """Verifies a job, and shows what was found beside the main window."""
    window = FreeCADGui.getMainWindow()
    bar = QtGui.QProgressDialog("Verifying %s" % job.Label, "Stop", 0, 0, window)
    bar.setWindowModality(QtCore.Qt.WindowModal)

    def progress(done, total, phase):
        bar.setLabelText(phase)
        bar.setMaximum(total)
        bar.setValue(min(done, total - 1) if total else 0)
        QtGui.QApplication.processEvents()
        if bar.wasCanceled():
            raise KeyboardInterrupt

    try:
        found = sweepsim_cam.verify(job, progress=progress)
    except KeyboardInterrupt:
        return
    except sweepsim.InputError as error:
        QtGui.QMessageBox.warning(window, "sweepsim", str(error))
        return
    finally:
        bar.close()
    list_widget = QtGui.QListWidget()
    list_widget.setWordWrap(True)
    for finding, operation in found.findings:
        label = operation.Label if operation else job.Label
        place = "%.3f, %.3f, %.3f" % tuple(finding.place)
        item = QtGui.QListWidgetItem("%s: %s, %.3f mm at (%s)" % (label, finding.kind, finding.depth, place))
        item.setData(QtCore.Qt.UserRole, operation.Name if operation else job.Name)
        list_widget.addItem(item)

    def select(item):
        FreeCADGui.Selection.clearSelection()
        FreeCADGui.Selection.addSelection(job.Document.Name, item.data(QtCore.Qt.UserRole))

    list_widget.itemClicked.connect(select)
    dock = QtGui.QDockWidget("%s: %s" % (job.Label, found.outcome.answer), window)
    dock.setWidget(list_widget)
    window.addDockWidget(QtCore.Qt.RightDockWidgetArea, dock)
