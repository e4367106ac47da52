"""What an add-on of any program needs: a client of the sidecar, forms from the schema, meshes, work beside.

Standard library only; nothing here knows of FreeCAD or Blender, whose packaging commands copy this folder.
"""
