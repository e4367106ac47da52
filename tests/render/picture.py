#!/usr/bin/env python3
"""A picture of exported solids, drawn without a display.

    picture.py OUT.png FILE.glb|FILES.stl [--view glass,cut,coolant] [--cut 0.5] [--azimuth 30] [--along-axis]

Views stand side by side: `metal` whole, `glass` with the coolant showing through, `cut` open at a part of its
height with the coolant rising out of it, `open` without coolant, inserts cut off higher up, `coolant` alone;
`row` whole but for the near half of its shroud, `half` all of a row cut through its axis, which is x.
"""

from __future__ import annotations

import argparse
import os
from pathlib import Path

if "DISPLAY" not in os.environ:  # or VTK looks for one first, and says so
    os.environ.setdefault("VTK_DEFAULT_OPENGL_WINDOW", "vtkEGLRenderWindow")

import numpy as np
import pyvista as pv
from PIL import Image

from solids import Solid, read

METAL, CUT_FACE, COOLANT, LINE = "#b6bac1", "#d3d7dc", "#1f6fd0", "#23272e"
INSERT = "#8fb8a6"
GLASS_FAR, GLASS_NEAR = "#dfe4ea", "#9fb4c8"
STEEL = {"pbr": True, "metallic": 0.85, "roughness": 0.38}
PLASTIC = {"pbr": True, "metallic": 0.0, "roughness": 0.35}
GLASS = {"ambient": 0.8, "diffuse": 0.22, "specular": 0.2, "specular_power": 30}
LINE_WIDTH, OVERSAMPLING = 1.2, 2
WINDOWS = [(1.9, 0.5), (0.6, 0.2), (-2.6, 0.3)]  # direction in radians, brightness


def studio() -> pv.Texture:
    """What the surfaces mirror: a light room with a bright ceiling and windows round about."""
    up, around = np.meshgrid(np.linspace(1, -1, 128), np.linspace(-np.pi, np.pi, 256), indexing="ij")
    light = 0.52 + 0.18 * up + 0.5 * np.exp(-(((up - 0.9) / 0.3) ** 2))
    for direction, strength in WINDOWS:
        light += strength * np.exp(-(((around - direction) / 0.6) ** 2) - ((up + 0.3) / 0.7) ** 2)
    texture = pv.Texture(np.repeat((255 * np.clip(light, 0, 1)).astype(np.uint8)[..., None], 3, axis=2))
    texture.mipmap, texture.interpolate = True, True
    return texture


class Stage:
    """A plotter with the room's light, and the views put on it from left to right."""

    def __init__(self, solids: list[Solid], azimuth: float, elevation: float, along_axis: bool = False):
        """Seen from so far, in degrees, beside the blade's broad side, or beside the machine's axis x."""
        self.solids = solids
        metal = [s for s in solids if s.is_metal] or solids
        points = np.concatenate([s.closed.points for s in metal])
        self.low, self.high = points.min(0), points.max(0)
        self.centre = (self.low + self.high) / 2
        self.facing = 0.0 if along_axis else broad_side(points)
        self.azimuth, self.elevation = np.radians(azimuth), np.radians(elevation)
        self.plotter = pv.Plotter(off_screen=True, lighting="none")
        self.plotter.set_background("white")
        self.plotter.set_environment_texture(studio(), is_srgb=True)
        self.plotter.renderer.SetEnvironmentUp(0, 0, 1)
        self.plotter.renderer.SetEnvironmentRight(*self.camera_axes()[0])

    def camera_axes(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """To the right, up and towards the viewer."""
        around = self.facing + self.azimuth
        flat = np.array([np.cos(around), np.sin(around), 0.0])
        towards = np.cos(self.elevation) * flat + np.sin(self.elevation) * np.array([0, 0, 1.0])
        right = np.cross([0, 0, 1.0], towards)
        right /= np.linalg.norm(right)
        return right, np.cross(towards, right), towards

    def extent(self) -> tuple[float, float]:
        """Width and height of the blade as the camera sees it; its middle there becomes the centre."""
        corners = np.concatenate([s.closed.points for s in self.solids]) - self.centre
        right, up, _ = self.camera_axes()
        across, along = corners @ right, corners @ up
        self.centre = self.centre + np.mean([across.min(), across.max()]) * right
        self.centre = self.centre + np.mean([along.min(), along.max()]) * up
        return float(np.ptp(across)), float(np.ptp(along))

    def add(self, surface: pv.PolyData, shift: np.ndarray, colour: str, **style) -> None:
        self.plotter.add_mesh(surface.translate(shift), color=colour, smooth_shading=True, **style)

    def add_lines(self, lines: pv.PolyData, shift: np.ndarray) -> None:
        if lines.n_cells:
            style = {"color": LINE, "line_width": LINE_WIDTH * OVERSAMPLING, "lighting": False}
            self.plotter.add_mesh(lines.translate(shift), **style)

    def view(self, kind: str, shift: np.ndarray, cut: float) -> None:
        for solid in self.solids:
            if solid.is_metal:
                self.metal(solid, kind, shift, cut)
            elif solid.is_insert:
                if kind == "open":
                    self.sawn(solid, shift, 0.5 * (cut + 1.0), INSERT)
            elif kind not in ("metal", "open"):
                self.add(solid.shaded, shift, COOLANT, **PLASTIC)
                self.add_lines(solid.edges, shift)

    def metal(self, solid: Solid, kind: str, shift: np.ndarray, cut: float) -> None:
        if kind == "metal":
            self.add(solid.shaded, shift, METAL, **STEEL)
            self.add_lines(solid.edges, shift)
        elif kind == "glass":
            skin = solid.only("blade/").shaded
            self.add(skin, shift, GLASS_FAR, culling="front", **GLASS)  # the far wall, behind the coolant
            self.add(skin, shift, GLASS_NEAR, culling="back", opacity=0.10, **GLASS)
            self.add_lines(solid.edges, shift)
        elif kind in ("cut", "open"):
            self.sawn(solid, shift, cut, METAL)
        elif kind == "half" or solid.is_shroud:
            self.halved(solid, shift)
        elif kind == "row":
            self.add(solid.shaded, shift, METAL, **STEEL)
            self.add_lines(solid.edges, shift)

    def sawn(self, solid: Solid, shift: np.ndarray, cut: float, colour: str) -> None:
        """The solid below a part of the blade's height, with the face that the saw leaves."""
        height = self.low[2] + cut * (self.high[2] - self.low[2])
        self.below(solid, shift, {"normal": (0, 0, 1), "origin": (0, 0, height)}, colour)

    def halved(self, solid: Solid, shift: np.ndarray) -> None:
        """The half of a solid beyond the upright plane through the axis, as the camera sees it."""
        self.below(
            solid, shift, {"normal": (0, np.sign(self.camera_axes()[2][1]), 0), "origin": (0, 0, 0)}, METAL
        )

    def below(self, solid: Solid, shift: np.ndarray, plane: dict, colour: str) -> None:
        """The solid on the near side of a plane, with the face that the saw leaves."""
        above = (solid.closed.points - plane["origin"]) @ plane["normal"] > 0
        if above.all():
            return
        section = solid.closed.slice(**plane)
        self.add(solid.shaded_below(plane), shift, colour, **STEEL)
        self.add_lines(solid.edges.clip(**plane), shift)
        if not above.any():
            return
        self.add(section.triangulate_contours(), shift, CUT_FACE, lighting=False)
        self.add_lines(section, shift)

    def shoot(self, views: list[str], cut: float, pixels: int) -> np.ndarray:
        """The picture, so many pixels wide and as high as it needs to be."""
        right, up, towards = self.camera_axes()
        width, height = self.extent()
        step = 1.12 * width
        for number, kind in enumerate(views):
            self.view(kind, (number - (len(views) - 1) / 2) * step * right, cut)
        margin = 0.06 * height
        wide, high = width + (len(views) - 1) * step + 2 * margin, height + 2 * margin
        self.plotter.window_size = [OVERSAMPLING * pixels, OVERSAMPLING * round(pixels * high / wide)]
        camera = self.plotter.camera
        camera.focal_point, camera.up = self.centre, up
        camera.position = self.centre + 20 * high * towards
        camera.parallel_projection, camera.parallel_scale = True, high / 2
        self.plotter.add_light(pv.Light(position=camera.position + 10 * high * (up - right), intensity=0.6))
        self.plotter.reset_camera_clipping_range()
        return self.plotter.screenshot(return_img=True)


def broad_side(points: np.ndarray) -> float:
    """Direction about z from which the blade is broadest."""
    flat = points[:, :2] - points[:, :2].mean(0)
    chord = np.linalg.svd(flat, full_matrices=False)[2][0]
    return float(np.arctan2(chord[0], -chord[1]))


def save(image: np.ndarray, path: Path) -> None:
    """Averages the oversampled pixels."""
    height, width = (n // OVERSAMPLING for n in image.shape[:2])
    Image.fromarray(image).resize((width, height), Image.Resampling.LANCZOS).save(path, optimize=True)


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("out", type=Path)
    parser.add_argument("files", type=Path, nargs="+")
    parser.add_argument("--view", default="glass,cut,coolant")
    parser.add_argument("--cut", type=float, default=0.5, help="part of the height at which the metal ends")
    parser.add_argument("--azimuth", type=float, default=30, help="degrees from the broad side")
    parser.add_argument("--along-axis", action="store_true", help="degrees from the axis x instead")
    parser.add_argument("--elevation", type=float, default=28)
    parser.add_argument("--width", type=int, default=1600, help="pixels")
    options = parser.parse_args()
    stage = Stage(read(options.files), options.azimuth, options.elevation, options.along_axis)
    save(stage.shoot(options.view.split(","), options.cut, options.width), options.out)


if __name__ == "__main__":
    main()
