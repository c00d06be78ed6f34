#!/usr/bin/env python3
"""Random configurations and damaged files, given to the program: it must refuse what it cannot do, and break nothing.

    python3 scripts/abuse.py                       2,000 configurations and 500 damaged files, 10 to 20 minutes of two cores
    python3 scripts/abuse.py --count 200           fewer, a quarter as many damaged files
    python3 scripts/abuse.py --program PATH        another program than target/release/peristalsis
    python3 scripts/abuse.py --seed 7 --only 123   one case again, with what it said

What must hold of each call: no panic, no crash, an exit code that the program names, an answer within the time limit (a
call that is still at work then is stopped and counted), an error in words where it is refused, and no file changed that was
there before unless the call says so by its success. Ends with 1 where anything does not hold.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parent.parent
SECONDS = 6
CODES = {0, 1, 2, 129, 130, 138, 143}
PRESETS = sorted(path.stem for path in (REPOSITORY / "crates/configuration/presets").glob("*.toml"))
SMALL = ("grains.number=12", "tube.waves=2", "run.periods=1")
STUDY = """name = "abused"
preset = "frictionless"
replicates = 2

[base]
grains.number = 12
tube.waves = 2
run.periods = 1

[[axes]]
key = "drive.width"
values = [2.5, 2.8]
"""
NUMBERS = (0, -0.0, 1, -1, 2, 3, 1e-300, 1e300, -1e300, 1e-9, 1e9, 1e6, 0.5, 1.5, 2**31, 2**32, 2**53, 2**63, 10**19)
ODDITIES = ("nan", "inf", "-inf", "true", '""', '"rest"', "[]", "[1]", "{}", "1979-05-27", "'\u00e9'", "0x10", "1_0", "jammed")


@dataclass
class Case:
    """A call: its words, what it reads from standard input, and the folder that it runs in."""

    words: list[str]
    text: str | None = None
    damaged: Path | None = None


def keys_of(schema: dict, path: str = "") -> dict[str, dict]:
    """Every key of a configuration with its schema."""
    found = {}
    for name, inner in schema.get("properties", {}).items():
        full = f"{path}.{name}" if path else name
        if "properties" in inner:
            found |= keys_of(inner, full)
        elif full not in ("preset", "resolved"):
            found[full] = inner
    return found


def value_of(schema: dict, dice: random.Random) -> str:
    """A value of a key: mostly one that it allows, sometimes a limit or beside it, sometimes anything."""
    kind = dice.random()
    if kind < 0.06:
        return dice.choice(ODDITIES)
    if kind < 0.12:
        return repr(dice.choice(NUMBERS))
    names = schema.get("enum") or [one["const"] for one in schema.get("oneOf", []) if "const" in one]
    if names:
        return json.dumps(dice.choice(names))
    if schema.get("type") == "boolean":
        return dice.choice(("true", "false"))
    if schema.get("type") not in ("number", "integer"):
        return dice.choice((
            '"ramp"',
            '{form="ramp", end=%g}' % dice.uniform(0, 3),
            '{form="steps", parameter="width", at=[0, 1], values=[%g, 2.5]}' % dice.uniform(0, 3),
            '[{form="course", parameter="strain_rate", at=[0, 0.5], values=[0.1, %g]}]' % dice.uniform(0, 50),
        ))
    least = schema.get("minimum", schema.get("exclusiveMinimum", -1e6))
    most = min(schema.get("maximum", 1e6), 1e15)
    value = dice.choice((
        least,
        most,
        dice.uniform(least, most),
        dice.uniform(max(least, 0), min(most, 1)),
        dice.uniform(max(least, 0), min(most, 3)),
        dice.uniform(max(least, -2), min(most, 30)),
        max(least, 10 ** dice.uniform(-12, 3)),
    ))
    return repr(round(value)) if schema["type"] == "integer" else repr(float(value))


def configuration_case(keys: dict[str, dict], folder: Path, dice: random.Random) -> Case:
    """Some keys with random values over a small tube, by --set, in a file, or on standard input."""
    settings = [f"{key}={value_of(keys[key], dice)}" for key in dice.sample(sorted(keys), dice.randint(1, 4))]
    if dice.random() < 0.1:
        settings.append(dice.choice(("", "=", "drive", "drive.widht=2", "a.b.c=1", "drive.width=", "[drive]\nwidth=2")))
    preset = dice.choice(PRESETS)
    words = [dice.choice(("check", "run"))]
    small = [f"--set={setting}" for setting in SMALL if setting.split("=")[0] not in " ".join(settings)]
    text = None
    if dice.random() < 0.5:
        words += ["--preset", preset, *small, *(f"--set={setting}" for setting in settings)]
    else:
        lines = [setting for setting in settings if "=" in setting]
        text = f'preset = "{preset}"\n' + "\n".join(lines) + "\n"
        if dice.random() < 0.1:
            text += dice.choice(("\x00", "[[", "# end", "a = 1\na = 2\n", "[drive]\nwidth = 2\n" * 2))
        if dice.random() < 0.5:
            words += ["-", *small]
        else:
            (folder / "given.toml").write_text(text)
            words += ["given.toml", *small]
            text = None
    if words[0] == "run":
        words += ["--quiet", "--out", "result"]
        words += dice.choice(([], ["--trajectory", "gsd"], ["--json"], ["--threads", "2"]))
    return Case(words, text)


def damaged(data: bytes, dice: random.Random) -> bytes:
    """Bytes flipped, cut off, doubled or lines in another order."""
    data = bytearray(data)
    way = dice.randrange(5)
    if way == 0:
        for _ in range(dice.choice((1, 1, 3, 20))):
            if data:
                data[dice.randrange(len(data))] ^= 1 << dice.randrange(8)
    elif way == 1:
        del data[dice.randrange(len(data) + 1):]
    elif way == 2:
        lines = data.split(b"\n")
        one, other = dice.randrange(len(lines)), dice.randrange(len(lines))
        lines[one], lines[other] = lines[other], lines[one]
        data = bytearray(b"\n".join(lines))
    elif way == 3:
        at = dice.randrange(len(data) + 1)
        data[at:at] = dice.randbytes(dice.choice((1, 8, 200)))
    else:
        at = dice.randrange(len(data) + 1)
        data[at:at + dice.choice((1, 8, 200))] = b""
    return bytes(data)


def damage_case(sound: Path, folder: Path, dice: random.Random) -> Case:
    """A copy of a run, a study file and a store, of which one file is damaged, and a command that reads it."""
    shutil.copytree(sound, folder, dirs_exist_ok=True)
    files = sorted(path for path in folder.rglob("*") if path.is_file() and path.suffix not in (".svg", ".png"))
    weighted = [file for file in files for _ in range(6 if file.parent.name == "run" or file.name == "study.toml" else 1)]
    file = dice.choice(weighted)
    file.write_bytes(damaged(file.read_bytes(), dice))
    place = file.relative_to(folder).parts[0]
    calls = {
        "run": [
            ["run", "--resume", "run", "--quiet"],
            ["run", "run/config.toml", "--quiet", "--out", "result"],
            ["check", "run/config.toml"],
            ["figures", "run"],
            ["render", "run", "--out", "picture.png"],
            ["render", "run", "--film", "--out", "film.gif"],
            ["trajectory", "run", "--duration", "0.1", "--out", "frames"],
        ],
        "study.toml": [["study", "plan", "study.toml"], ["study", "run", "study.toml", "--quiet"]],
        "store": [
            ["study", "status", "store"],
            ["study", "run", "study.toml", "--store", "store", "--quiet"],
            ["study", "export", "store"],
            ["study", "verify", "store"],
        ],
    }
    return Case(dice.choice(calls[place]), damaged=file)


def inventory(folder: Path) -> dict[str, str]:
    """Every file below a folder with the digest of what it holds."""
    files = (path for path in folder.rglob("*") if path.is_file())
    return {str(path.relative_to(folder)): hashlib.sha256(path.read_bytes()).hexdigest() for path in files}


def call(program: Path, case: Case, folder: Path, seconds: float) -> tuple[int | None, str, str]:
    """Exit code (None: still at work at the end of the time), standard output and error."""
    environment = {**os.environ, "RUST_BACKTRACE": "0", "NO_COLOR": "1"}
    process = subprocess.Popen(
        [program, *case.words],
        cwd=folder,
        env=environment,
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    )
    try:
        out, err = process.communicate((case.text or "").encode("utf-8", "replace"), timeout=seconds)
        code = process.returncode
    except subprocess.TimeoutExpired:
        process.send_signal(signal.SIGTERM)
        try:
            out, err = process.communicate(timeout=max(60, seconds))
        except subprocess.TimeoutExpired:
            process.kill()
            out, err = process.communicate()
            err += b"\nabuse: it did not stop at SIGTERM"
        code = None
    return code, out.decode("utf-8", "replace"), err.decode("utf-8", "replace")


def faults(case: Case, code: int | None, out: str, err: str, before: dict[str, str], after: dict[str, str]) -> list[str]:
    """What does not hold of a call."""
    found = []
    if "panicked" in err or "Traceback" in err:
        found.append("panic")
    if "did not stop at SIGTERM" in err:
        found.append("does not stop")
    if code is not None and code not in CODES:
        found.append(f"exit code {code}")
    if code in (1, 2) and not err.strip() and not out.strip():
        found.append("fails without a word")
    if len(err) > 200_000:
        found.append("more than 200 kB on standard error")
    # What was moved aside is still there.
    there = set(after.values())
    gone = [name for name, digest in before.items() if digest not in there]
    reads_only = case.words[0] in ("check", "render", "trajectory") or case.words[:2] in (["study", "plan"], ["study", "status"])
    if gone and (code == 2 or reads_only):
        found.append(f"changed or lost: {', '.join(gone)}")
    lost = [name for name in gone if name not in after]
    if lost and code != 2 and not reads_only:
        found.append(f"lost: {', '.join(lost)}")
    return found


def sound_folder(program: Path, folder: Path) -> None:
    """A run with a trajectory, stopped half-way, and a store of a study, which the damages begin from."""
    folder.mkdir()
    small = [f"--set={setting}" for setting in SMALL]
    run = ["run", "--preset", "frictionless", *small, "--trajectory", "gsd", "--csv", "--quiet", "--out", "run"]
    (folder / "study.toml").write_text(STUDY)
    for words in (run, ["study", "run", "study.toml", "--store", "store", "--quiet"]):
        subprocess.run([program, *words], cwd=folder, check=True, capture_output=True)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", type=Path, default=REPOSITORY / "target" / "release" / "peristalsis")
    parser.add_argument("--count", type=int, default=2000, help="configurations; a quarter as many damaged files")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--seconds", type=float, default=SECONDS, help="time limit of a call")
    parser.add_argument("--workers", type=int, default=os.cpu_count() or 2)
    parser.add_argument("--only", type=int, help="the case of this number alone, with what it said")
    options = parser.parse_args()
    program = options.program.resolve()
    schema = json.loads(subprocess.run([program, "schema"], check=True, capture_output=True).stdout)
    keys = keys_of(schema)

    with tempfile.TemporaryDirectory(prefix="abuse-") as root:
        sound = Path(root) / "sound"
        sound_folder(program, sound)

        def judge(number: int) -> tuple[int, Case, int | None, str, list[str]]:
            dice = random.Random(f"{options.seed} {number}")
            folder = Path(root) / str(number)
            folder.mkdir()
            is_configuration = number < options.count
            case = configuration_case(keys, folder, dice) if is_configuration else damage_case(sound, folder, dice)
            before = inventory(folder)
            code, out, err = call(program, case, folder, options.seconds)
            found = faults(case, code, out, err, before, inventory(folder))
            if case.damaged:
                case.words.append(f"({case.damaged.relative_to(folder)} damaged)")
            shutil.rmtree(folder)
            return number, case, code, out + err, found

        numbers = range(options.count + options.count // 4) if options.only is None else [options.only]
        codes: dict[int | None, int] = {}
        bad = 0
        begin = time.monotonic()
        with ThreadPoolExecutor(options.workers) as pool:
            for number, case, code, said, found in pool.map(judge, numbers):
                codes[code] = codes.get(code, 0) + 1
                done = sum(codes.values())
                if done % 100 == 0:
                    print(f"{done} of {len(numbers)} calls, {bad} with faults, {time.monotonic() - begin:.0f} s", file=sys.stderr)
                if found or options.only is not None:
                    bad += bool(found)
                    print(f"case {number}: {'; '.join(found) or 'sound'}: {' '.join(map(repr, case.words))} -> {code}")
                    print((case.text or "") + said[-1500:], flush=True)
    told = ", ".join(f"{'stopped' if code is None else code}: {many}" for code, many in sorted(codes.items(), key=str))
    print(f"{len(numbers)} calls, {bad} with faults; exit codes {told}")
    return int(bad > 0)


if __name__ == "__main__":
    sys.exit(main())
