"""Widgets for a form's nodes. They write into the design as they are edited and tell the panel."""
