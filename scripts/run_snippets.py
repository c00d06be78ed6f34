"""Runs the Python snippets of Markdown files, those of each file one after another in one namespace."""

import re
import sys
from pathlib import Path

for path in map(Path, sys.argv[1:]):
    snippets = re.findall(r"^```python\n(.*?)^```", path.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)
    if not snippets:
        sys.exit(f"{path} has no Python snippet")
    names: dict[str, object] = {}
    for number, snippet in enumerate(snippets, 1):
        exec(compile(snippet, f"{path}, snippet {number}", "exec"), names)
    print(f"{path.name}: {len(snippets)} snippets ran")
