"""Runs the blocks of Markdown pages in one fresh folder a page, in the order in which they stand, and compares output.

```sh runs in bash and must succeed, ```sh,fails must exit with 2; ```python runs in one namespace a page;
```toml,file=NAME is written to NAME. A ```text block right behind a block of these is its output, in which `...` stands
for anything (on a line of its own: for any lines); another ```text block is only shown, as are blocks of other kinds.
Commands that take longer than a reader waits are parsed only (`PARSED`): `--help` behind them finds unknown options.

    run_snippets.py [--only sh|python] [--programs DIR] [--together] [--draw] PAGE ...
"""

import argparse
import contextlib
import io
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import warnings

ROOT = pathlib.Path(__file__).resolve().parent.parent
BLOCK = re.compile(r"^```([\w,=.-]+)\n(.*?)^```\n(?:\n*```text\n(.*?)^```$)?", re.MULTILINE | re.DOTALL)
#: Commands that are parsed only, each with the reason.
PARSED = {
    r"peristalsis view\b": "waits for a browser",
    r"peristalsis reproduce( --(full|check) .*| --fresh| --quick)?$": "takes minutes to hours",
    r"peristalsis study (run|status|export) \S*(examples/studies/|stores/)jamming-width": "takes some minutes",
    r"peristalsis render .*--film": "takes a minute",
}
#: Commands that are not run at all.
LEFT_OUT = {r"cargo test\b": "a check of its own", r"cargo install\b": "builds the program anew", r"just\b": "a recipe of its own"}
#: Pictures of a page and the file that the block that makes it leaves: the same bytes.
PICTURES = {
    "README.md": {"docs/images/flow.png": "runs/frictionless-1/flow.png"},
    "first-transition.md": {"docs/images/flow.png": "narrow/flow.png", "docs/images/flow-wide.png": "wide/flow.png"},
    "hysteresis.md": {"docs/images/sweep.png": "sweep/flow.png"},
}


def shell(text: str) -> str:
    """The commands as they are run here."""
    lines = []
    for line in re.sub(r"\\\n\s*", "", text).splitlines():
        command = re.sub(r"^cargo run --release --( |$)", "peristalsis ", line)
        bare = re.sub(r"(^|\s+)#.*$", "", command).strip()
        if any(re.match(pattern, bare) for pattern in LEFT_OUT):
            continue
        parsed = any(re.match(pattern, bare) for pattern in PARSED)
        lines.append(f"{bare} --help > /dev/null" if parsed else command)
    return "\n".join(lines)


def compare(page: str, block: str, expected: str, output: str) -> None:
    """Ends the program where an output is not the one that the page gives."""
    anything = re.escape("...")
    pattern = "".join(
        "(?:.*\n)*?" if line == "..." else re.escape(line).replace(anything, ".*") + "\n" for line in expected.splitlines()
    )
    if not re.fullmatch(pattern, "".join(f"{line.rstrip()}\n" for line in output.splitlines())):
        sys.exit(f"{page}: the output of\n{block}\nis not\n{expected}\nbut\n{output}")


def run_shell(page: str, text: str, options: list[str], folder: pathlib.Path, programs: pathlib.Path) -> str:
    done = subprocess.run(
        ["bash", "-euo", "pipefail", "-c", shell(text)],
        cwd=folder,
        env=os.environ | {"PATH": f"{programs}:{os.environ['PATH']}"},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )
    if done.returncode != (2 if "fails" in options else 0):
        sys.exit(f"{page}: exit code {done.returncode}\n{text}\n{done.stdout}")
    return done.stdout


def run_python(page: str, text: str, names: dict[str, object]) -> str:
    written = io.StringIO()
    with contextlib.redirect_stdout(written), warnings.catch_warnings():
        # An example shows nothing doubtful.
        warnings.simplefilter("error", UserWarning)
        exec(compile(text, f"{page}, {text.splitlines()[0]}", "exec"), names)
    return written.getvalue()


def run(page: str, folder: pathlib.Path, only: str | None, programs: pathlib.Path, draw: bool) -> None:
    names: dict[str, object] = {"__name__": "__main__"}
    number, pictures = 0, dict(PICTURES.get(pathlib.Path(page).name, {}))
    blocks = BLOCK.findall(pathlib.Path(page).read_text(encoding="utf-8"))
    os.chdir(folder)
    for kind, text, expected in blocks:
        kind, *options = kind.split(",")
        if kind == "toml":
            for option in options:
                (folder / option.removeprefix("file=")).write_text(text, encoding="utf-8")
        elif kind in ("sh", "python") and only in (None, kind):
            output = run_shell(page, text, options, folder, programs) if kind == "sh" else run_python(page, text, names)
            number += 1
            if expected:
                compare(page, text, expected, output)
            for picture, left in [each for each in pictures.items() if (folder / each[1]).exists()]:
                if draw:
                    shutil.copyfile(folder / left, ROOT / picture)
                if (folder / left).read_bytes() == (ROOT / picture).read_bytes():
                    del pictures[picture]
    if not number:
        sys.exit(f"{page} has no block to run")
    if pictures and only != "python":
        sys.exit(f"{', '.join(pictures)}: not as {page} draws it; scripts/run_snippets.py --only sh --draw {page}")
    print(f"{page}: {number} blocks")


def main() -> None:
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("pages", nargs="+", metavar="PAGE")
    arguments.add_argument("--only", choices=("sh", "python"), help="run blocks of this kind only")
    arguments.add_argument("--programs", default=ROOT / "target/release", type=pathlib.Path, help="where the program is")
    arguments.add_argument("--together", action="store_true", help="all pages in one folder, one after another")
    arguments.add_argument("--draw", action="store_true", help="put the pictures that the commands drew into the pages")
    chosen = arguments.parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        programs, pages = chosen.programs.resolve(), [str(pathlib.Path(page).resolve()) for page in chosen.pages]
        for number, page in enumerate(pages):
            folder = pathlib.Path(scratch, "all" if chosen.together else str(number))
            folder.mkdir(exist_ok=True)
            for part in ("examples", "studies", "validation"):
                if not (folder / part).exists():
                    (folder / part).symlink_to(ROOT / part)
            run(page, folder, chosen.only, programs, chosen.draw)


if __name__ == "__main__":
    main()
