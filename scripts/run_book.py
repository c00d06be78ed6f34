"""Executes the blocks of the book's pages in one fresh folder, in the order in which they stand.

```sh runs in bash and must succeed, ```sh,fails must exit with 2; ```toml,file=NAME is written to NAME; ```text is
only shown (what waits for a person).
"""

import os
import pathlib
import re
import subprocess
import sys
import tempfile

BLOCK = re.compile(r"^```(\S+)\n(.*?)^```$", re.MULTILINE | re.DOTALL)

programs = pathlib.Path("target/release").resolve()
environment = os.environ | {"PATH": f"{programs}:{os.environ['PATH']}"}
with tempfile.TemporaryDirectory() as folder:
    for page in sys.argv[1:]:
        blocks = BLOCK.findall(pathlib.Path(page).read_text())
        if not blocks:
            sys.exit(f"{page} has no block")
        for kind, text in blocks:
            kind, *options = kind.split(",")
            if kind == "text":
                continue
            if kind == "toml":
                name = next(option.removeprefix("file=") for option in options)
                pathlib.Path(folder, name).write_text(text)
                continue
            if kind != "sh":
                sys.exit(f"{page}: a block of {kind}: sh, toml or text is meant")
            done = subprocess.run(
                ["bash", "-euo", "pipefail", "-c", text], cwd=folder, env=environment, capture_output=True, text=True
            )
            if done.returncode != (2 if "fails" in options else 0):
                sys.exit(f"{page}: exit code {done.returncode}\n{text}\n{done.stdout}{done.stderr}")
        print(f"{page}: {len(blocks)} blocks")
