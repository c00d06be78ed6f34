"""Notices of what the program, the wheel and the page carry from others: THIRD-PARTY.txt, from `cargo metadata`.

third_party.py           writes it
third_party.py --check   fails where it is not what Cargo.lock says, or where a licence is unknown
"""

import json
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
NOTICES = ROOT / "THIRD-PARTY.txt"
#: What is handed out: the program with the viewer's page, the Python package, the page with its WebAssembly.
SHIPPED = ("peristalsis", "peristalsis-python", "peristalsis-viewer")
#: Licences in the order in which they are taken where a crate offers several; each with a phrase of its text.
TAKEN = {
    "MIT": "Permission is hereby granted",
    "MIT-0": "Permission is hereby granted",
    "Apache-2.0": "Apache License",
    "BSD-3-Clause": "Redistribution and use",
    "BSD-2-Clause": "Redistribution and use",
    "ISC": "Permission to use, copy, modify",
    "Zlib": "This software is provided 'as-is'",
    "0BSD": "Permission to use, copy, modify",
    "Unicode-3.0": "UNICODE LICENSE",
    "CC0-1.0": "CC0",
    "Unlicense": "public domain",
    "MPL-2.0": "Mozilla Public License",
    "Apache-2.0 WITH LLVM-exception": "Apache License",
}
#: Beside the crates: what it is, its licence, and the file with its text.
OTHERS = [
    ("Arimo 1.33, a subset embedded in figures", "OFL-1.1", "crates/figures/fonts/OFL.txt"),
    ("three.js, in the viewer's page", "MIT", "viewer/three-license.txt"),
]
FILE = re.compile(r"(?i)^(licen[cs]e|copying|unlicense)")
RULE = "-" * 78


def packages() -> list[dict]:
    """The crates of others that are linked into what is handed out, on any system, by name."""
    command = ["cargo", "metadata", "--format-version", "1", "--locked", "--all-features"]
    metadata = json.loads(subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True).stdout)
    by_id = {package["id"]: package for package in metadata["packages"]}
    nodes = {node["id"]: node for node in metadata["resolve"]["nodes"]}
    found, waiting = set(), [each for each, package in by_id.items() if package["name"] in SHIPPED]
    while waiting:
        here = waiting.pop()
        if here in found:
            continue
        found.add(here)
        for dependency in nodes[here]["deps"]:
            is_macro = any("proc-macro" in target["kind"] for target in by_id[dependency["pkg"]]["targets"])
            if not is_macro and any(kind["kind"] is None for kind in dependency["dep_kinds"]):
                waiting.append(dependency["pkg"])
    shipped = [by_id[each] for each in found if by_id[each]["source"]]
    return sorted(shipped, key=lambda package: (package["name"], package["version"]))


def choices(expression: str) -> list[list[str]]:
    """The alternatives of a licence's expression, each with all the licences that it asks for together."""
    alternatives = [[]]
    for part in re.split(r"\s+AND\s+", expression.replace("/", " OR ")):
        offered = re.split(r"\s+OR\s+", part.strip("() "))
        alternatives = [[*before, one] for before in alternatives for one in offered]
    return alternatives


def taken(package: dict) -> list[str]:
    order = list(TAKEN)
    known = [each for each in choices(package["license"] or "") if all(one in TAKEN for one in each)]
    if not known:
        sys.exit(f"{package['name']} {package['version']}: unknown licence {package['license']}")
    return min(known, key=lambda each: [order.index(one) for one in each])


def texts(package: dict) -> list[str]:
    files = sorted(each for each in Path(package["manifest_path"]).parent.iterdir() if each.is_file() and FILE.match(each.name))
    return [each.read_text(encoding="utf-8", errors="replace") for each in files]


def parted(text: str, phrase: str) -> tuple[str, str]:
    """Lines of copyright, and the licence itself without them."""
    lines = [line.strip() for line in text.splitlines()]
    owners = [line for line in lines if re.match(r"(?i)^(copyright (\(c\)|©|\d)|(\(c\)|©) ?\d)", line)]
    rest = "\n".join(line.rstrip() for line in text.splitlines() if line.strip() not in owners)
    return "; ".join(owners), rest[rest.index(phrase) :].strip() if phrase in rest else rest.strip()


def notices() -> str:
    crates = packages()
    groups: dict[str, dict[str, list[str]]] = {}
    further = []
    for package in crates:
        name, found = f"{package['name']} {package['version']}", texts(package)
        folder = Path(package["manifest_path"]).parent
        further += [(name, each.read_text(encoding="utf-8").strip()) for each in sorted(folder.glob("NOTICE*"))]
        for licence in taken(package):
            text = next((each for each in found if TAKEN[licence].lower() in each.lower()), "")
            owners, body = parted(text, TAKEN[licence])
            owners = owners or ", ".join(package["authors"]) or "the authors of the crate"
            by_text = groups.setdefault(licence, {})
            # The same words with other line breaks are the same licence.
            same = next((each for each in by_text if each.split() == body.split()), body)
            by_text.setdefault(same, []).append(f"{name}: {owners}")
    written = [
        "What peristalsis carries from others\n\nThe program, the Python wheel and the page in the browser contain these "
        "works. scripts/third_party.py\nwrites this file from Cargo.lock. Where a work offers several licences, one is taken.\n"
        "The standard library of Rust is linked, too: MIT or Apache-2.0, the Rust project contributors."
    ]
    for licence, by_text in sorted(groups.items()):
        # A crate without a text of its own stands with the others of its licence.
        nameless = by_text.pop("", [])
        if nameless and not by_text:
            sys.exit(f"no text of {licence} for {', '.join(nameless)}")
        for number, (body, names) in enumerate(sorted(by_text.items(), key=lambda each: (-len(each[1]), each[0]))):
            names = sorted([*names, *(nameless if number == 0 else [])])
            written.append(f"{licence}\n\n" + "\n".join(f"* {name}" for name in names) + f"\n\n{body}")
    written += [f"NOTICE of {name}\n\n{text}" for name, text in further]
    for what, licence, path in OTHERS:
        written.append(f"{what}: {licence}\n\n{(ROOT / path).read_text(encoding='utf-8').strip()}")
    return f"\n\n{RULE}\n".join(written) + "\n"


text = notices()
if sys.argv[1:] == ["--check"]:
    if not NOTICES.exists() or NOTICES.read_text(encoding="utf-8") != text:
        sys.exit("THIRD-PARTY.txt is not what Cargo.lock says: python3 scripts/third_party.py writes it")
    print(f"{len(packages())} crates and {len(OTHERS)} other works")
else:
    NOTICES.write_text(text, encoding="utf-8")
