"""A job of FreeCAD's CAM workbench, verified: without a window.

    import sweepsim_cam
    for finding, operation in sweepsim_cam.verify(job).findings:
        print(operation.Label if operation else "", finding.kind, finding.depth)
"""

import importlib
import os
import re
import tempfile
from math import radians, tan

import MeshPart
import sweepsim

#: How far triangles may be from the faces of the model and the stock, in millimetres.
DEFLECTION = 0.005


class Verified:
    """What was found, each finding with the operation that does it, or None."""

    def __init__(self, outcome, findings, program):
        self.outcome = outcome
        self.findings = findings
        self.program = program


def verify(job, **options):
    """Verifies a job: its program as post-processed, tools, stock and model. Options are those of `sweepsim.verify`."""
    program, operations = post_processed(job)
    options.setdefault("limits", (0.02, 0.1))
    outcome = sweepsim.verify(
        program,
        tools=tools(job),
        stock=solid(job.Stock.Shape),
        target=mesh([part.Shape for part in job.Model.Group]),
        name="%s.ngc" % job.Label,
        **options,
    )
    findings = [(finding, operations.get(finding.line)) for finding in outcome.findings]
    return Verified(outcome, findings, program)


def tools(job):
    """The tools by their numbers, in the notation of jobs."""
    made = {}
    for controller in job.Tools.Group:
        notation = tool(controller.Tool)
        if made.setdefault(controller.ToolNumber, notation) != notation:
            raise sweepsim.InputError(
                "%s: there are two tools %d: expected a number for each" % (job.Label, controller.ToolNumber)
            )
    return made


def tool(bit):
    """A tool bit in the notation of jobs."""
    shape = str(getattr(bit, "ShapeName", "") or os.path.splitext(os.path.basename(bit.BitShape))[0]).lower()
    radius = bit.Diameter.Value / 2
    length = (getattr(bit, "CuttingEdgeHeight", None) or bit.Length).Value
    if shape == "endmill":
        return "Flat(radius: %r, length: %r)" % (radius, length)
    if shape == "ballend":
        return "Ball(radius: %r, length: %r)" % (radius, length)
    if shape == "bullnose":
        corner = getattr(bit, "CornerRadius", None) or bit.FlatRadius
        return "Bull(radius: %r, corner: %r, length: %r)" % (radius, corner.Value, length)
    if shape in ("drill", "v-bit", "chamfer"):
        angle = getattr(bit, "TipAngle", None) or bit.CuttingEdgeAngle
        tip = getattr(bit, "TipDiameter", None)
        tip = tip.Value / 2 if tip is not None and shape != "drill" else 0.0
        top = (radius - tip) / tan(radians(angle.Value) / 2)
        length = max(length, 1.01 * top)
        corners = [(tip, 0.0)] * (tip > 0) + [(radius, top), (radius, length), (0.0, length)]
        return "Profile(start: (0, 0), segments: [%s])" % ", ".join("Line((%r, %r))" % corner for corner in corners)
    raise sweepsim.InputError(
        "%s: a tool of the shape %r: expected an end mill, a ball end, a bull nose, a drill, a V-bit or a chamfer cutter"
        % (bit.Label, shape)
    )


def mesh(shapes):
    """The vertices and triangles of solids."""
    vertices, triangles = [], []
    for shape in shapes:
        points, faces = MeshPart.meshFromShape(Shape=shape, LinearDeflection=DEFLECTION).Topology
        triangles += [[number + len(vertices) for number in face] for face in faces]
        vertices += [(point.x, point.y, point.z) for point in points]
    return vertices, triangles


def solid(shape):
    """A stock: a block as such, anything else as a mesh."""
    box = shape.BoundBox
    volume = box.XLength * box.YLength * box.ZLength
    if abs(shape.Volume - volume) <= 1e-9 * volume:
        return "block:%r,%r,%r,%r,%r,%r" % (box.XMin, box.YMin, box.ZMin, box.XMax, box.YMax, box.ZMax)
    return mesh([shape])


def post_processed(job):
    """The program as LinuxCNC's post-processor writes it, and the operation of each of its lines.

    Verification wants the moves, which are the same for every control; this post-processor says where an operation
    begins.
    """
    objects, last = [], None
    for operation in job.Operations.Group:
        if not getattr(operation, "Active", True):
            continue
        controller = getattr(operation, "ToolController", None)
        if controller is not None and controller is not last:
            objects.append(controller)
            last = controller
        objects.append(operation)
    handle, file = tempfile.mkstemp(suffix=".ngc")
    os.close(handle)
    try:
        _post().export(objects, file, "--no-show-editor --precision 6")
        with open(file) as written:
            program = written.read()
    finally:
        os.remove(file)
    labels = {operation.Label: operation for operation in objects}
    operations, present = {}, None
    for number, line in enumerate(program.splitlines(), 1):
        begins = re.search(r"\(\s*begin operation: (.*?)\s*\)", line, re.I)
        ends = re.search(r"\(\s*finish operation: ", line, re.I)
        if begins:
            present = labels.get(begins[1])
        operations[number] = present
        if ends:
            present = None
    return program, operations


def _post():
    # The names of FreeCAD 0.20, and of later ones.
    for name in ("PathScripts.post.linuxcnc_post", "Path.Post.scripts.linuxcnc_post"):
        try:
            return importlib.import_module(name)
        except ImportError:
            continue
    raise RuntimeError("FreeCAD's CAM workbench has no post-processor of LinuxCNC")
