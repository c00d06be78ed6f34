"""The reference of the command line in Markdown, on standard output: the `--help` of the program and of all its commands."""

import re
import subprocess
import sys

PROGRAM = sys.argv[1]


def write(words: list[str]) -> None:
    """A section for a command, and one for each command below it."""
    shown = subprocess.run([PROGRAM, *words, "--help"], check=True, capture_output=True, text=True).stdout.rstrip()
    print(f"{'#' * (2 + len(words[1:]))} {' '.join(['peristalsis', *words])}\n\n```text\n{shown}\n```\n")
    listed = re.search(r"^Commands:\n((?:  .*\n)+)", shown, re.MULTILINE)
    for name in re.findall(r"^  (\w+) ", listed[1], re.MULTILINE) if listed else []:
        if name != "help":
            write([*words, name])


write([])
