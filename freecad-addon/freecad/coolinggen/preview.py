"""A blade's meshes in the 3D view while it is edited, without an object in the document."""

import FreeCADGui as Gui
from pivy import coin

from .client.mesh import Mesh


class Preview:
    """Meshes under a view's root; ``clear`` takes them away."""

    def __init__(self, view=None):
        view = view or Gui.ActiveDocument.ActiveView
        self._root = view.getSceneGraph()
        self._node = coin.SoSeparator()
        self._node.setName("CoolingGenPreview")
        self._place = coin.SoTransform()
        self._parts: dict[str, coin.SoSwitch] = {}
        self._node.addChild(self._place)
        self._root.addChild(self._node)
        self.visible = {"metal": True, "insert": True, "coolant": False}
        self.glass = False
        self._meshes: list[Mesh] = []

    def place(self, placement) -> None:
        """Puts the meshes where the blade stands."""
        base, rotation = placement.Base, placement.Rotation.Q
        self._place.translation.setValue(base.x, base.y, base.z)
        self._place.rotation.setValue(*rotation)

    def show(self, meshes: list[Mesh]) -> None:
        """Shows these meshes in the place of the last."""
        self._meshes = meshes
        for switch in self._parts.values():
            self._node.removeChild(switch)
        self._parts = {}
        for mesh in meshes:
            switch = coin.SoSwitch()
            switch.addChild(mesh_node(mesh, 0.7 if self.glass and _part(mesh) == "metal" else 0.0))
            self._parts[mesh.name] = switch
            self._node.addChild(switch)
        self.update()

    def update(self) -> None:
        """Heeds ``visible``."""
        for name, switch in self._parts.items():
            shown = self.visible.get(name.split("/")[0].split("#")[0], True)
            switch.whichChild = coin.SO_SWITCH_ALL if shown else coin.SO_SWITCH_NONE

    def look(self, *, metal: bool, coolant: bool, glass: bool) -> None:
        """Which parts are shown, and whether the metal lets the rest be seen."""
        self.visible.update(metal=metal, coolant=coolant)
        if glass != self.glass:
            self.glass = glass
            self.show(self._meshes)
        self.update()

    @property
    def shown(self) -> int:
        """Number of triangles shown."""
        return sum(len(mesh.triangles) // 3 for mesh in self._meshes)

    def clear(self) -> None:
        """Takes it out of the view."""
        self._root.removeChild(self._node)


def _part(mesh: Mesh) -> str:
    return mesh.name.split("/")[0]


def mesh_node(mesh: Mesh, transparency: float = 0.0, by_vertex: list | None = None) -> coin.SoSeparator:
    """A mesh for a 3D view, in the colours of its faces or one for each vertex."""
    group = coin.SoSeparator()
    # Translucent triangles of one body are not sorted; both sides are drawn.
    hints = coin.SoShapeHints()
    hints.vertexOrdering = coin.SoShapeHints.COUNTERCLOCKWISE
    hints.shapeType = coin.SoShapeHints.UNKNOWN_SHAPE_TYPE
    group.addChild(hints)
    if by_vertex is None:
        palette = {color: k for k, color in enumerate(dict.fromkeys(face.color for face in mesh.faces))}
        shades, way = list(palette), coin.SoMaterialBinding.PER_FACE_INDEXED
    else:
        shades, way = by_vertex, coin.SoMaterialBinding.PER_VERTEX_INDEXED
    material = coin.SoMaterial()
    material.diffuseColor.setValues(0, len(shades), [list(color) for color in shades])
    material.transparency.setValue(transparency)
    group.addChild(material)
    binding = coin.SoMaterialBinding()
    binding.value = way
    group.addChild(binding)
    points = coin.SoCoordinate3()
    points.point.setValues(0, len(mesh.vertices) // 3, _triples(mesh.vertices))
    group.addChild(points)
    normals = coin.SoNormal()
    normals.vector.setValues(0, len(mesh.normals) // 3, _triples(mesh.normals))
    group.addChild(normals)
    per_vertex = coin.SoNormalBinding()
    per_vertex.value = coin.SoNormalBinding.PER_VERTEX_INDEXED
    group.addChild(per_vertex)
    faces = coin.SoIndexedFaceSet()
    corners = []
    t = mesh.triangles
    for a, b, c in zip(t[0::3], t[1::3], t[2::3], strict=True):
        corners += (a, b, c, -1)
    faces.coordIndex.setValues(0, len(corners), corners)
    if by_vertex is None:
        colors = [palette[face.color] for face in mesh.faces for _ in face.triangles]
    else:
        colors = corners
    faces.materialIndex.setValues(0, len(colors), colors)
    group.addChild(faces)
    return group


def _triples(numbers) -> list[tuple[float, float, float]]:
    return list(zip(numbers[0::3], numbers[1::3], numbers[2::3], strict=True))
