"""What every add-on needs, whatever program it lives in: the sidecar's client and the design's form.

Nothing here knows of FreeCAD or Blender. The packaging commands put this folder into each add-on.
"""
