"""The form of a design, from the schema of the sidecar that the add-on was packed with."""

import json
from pathlib import Path

from .client import forms

FORM = forms.form(json.loads((Path(__file__).parent / "schema.json").read_text(encoding="utf-8")))
