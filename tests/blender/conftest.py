"""The extension, packed and installed as a user would, in the `bpy` module of one Blender."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

# Before `bpy` is there: it must not see the user's own Blender.
_HOME = Path(tempfile.mkdtemp(prefix="coolinggen blender "))
os.environ["BLENDER_USER_RESOURCES"] = str(_HOME)

import bpy  # noqa: E402
import pytest  # noqa: E402

ROOT = Path(__file__).resolve().parents[2]
BINARY = Path(os.environ.get("COOLINGGEN", ROOT / "target/release/coolinggen")).resolve()
MODULE = "bl_ext.user_default.coolinggen"


def install() -> None:
    """Packs the extension and installs it."""
    command = [sys.executable, ROOT / "blender-addon/package.py", _HOME / "made", "--binary", BINARY]
    packed = subprocess.run(command, check=True, capture_output=True, text=True).stdout.strip()
    bpy.ops.extensions.package_install_files(filepath=packed, repo="user_default", enable_on_install=True)


@pytest.fixture(scope="session", autouse=True)
def _installed():
    install()
    yield
    bpy.ops.preferences.addon_disable(module=MODULE)
    shutil.rmtree(_HOME, ignore_errors=True)


@pytest.fixture(autouse=True)
def _fresh():
    """Each test has an empty file and the sidecar that the extension brought."""
    bpy.ops.wm.read_homefile(use_empty=True)
    bpy.context.preferences.addons[MODULE].preferences.binary = ""
    bpy.context.scene.unit_settings.scale_length = 1.0


@pytest.fixture
def rotor():
    """The collection of the template `rotor`, built."""
    assert bpy.ops.coolinggen.new(template="rotor") == {"FINISHED"}
    return bpy.data.collections["rotor"]
