"""Writes the classes of what estimators answer, crates/python/python/peristalsis/analysis/_results.py.

They are made of the schemas of these types in Rust, as the installed package knows them, with the examples of the functions
that answer them: `python scripts/python_results.py`. A test says whether the file is up to date.
"""

import ast
import json
import sys
import textwrap
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from peristalsis import _core
from python_types import kind_of, parts, plain

OUT = Path(__file__).parent.parent / "crates/python/python/peristalsis/analysis/_results.py"

HEAD = '''"""What estimators answer. Made by scripts/python_results.py from the schemas of these types in Rust."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal
'''

#: What classes do beside holding their fields.
METHODS = {
    "Uncertain": '''
    def __str__(self) -> str:
        return f"{self.value:.6g} +- {self.error:.2g}"
'''
}

#: Examples of classes that nothing answers by itself, or whose example does not show them well.
EXAMPLES = {
    "CollapseEstimate": """
>>> import numpy as np
>>> from peristalsis import analysis
>>> x = np.linspace(-0.5, 0.5, 21)
>>> curves = [(size, x, size**-0.5 / (1 + np.exp(x * size)), np.full(21, 0.003)) for size in (4.0, 8.0, 16.0)]
>>> collapse = analysis.Collapse(curves, "finite_size")
>>> estimate = collapse.fit([0.4, 0.9, 0.0], [0.1, 0.1, 0.02], starts=2).estimate
>>> [round(parameter.value, 1) for parameter in estimate.parameters], estimate.starts
([0.5, 1.0, 0.0], 2)
""",
    "Interval": """
>>> from peristalsis import analysis
>>> analysis.Interval(0.5, 1.5).upper
1.5
""",
    "Uncertain": """
>>> from peristalsis import analysis
>>> slope = analysis.fit_line([0, 1, 2], [1, 3, 5], [0.1, 0.1, 0.1]).slope
>>> print(slope)
2 +- 0.071
>>> slope.interval_68.lower < 2.0 < slope.interval_68.upper
True
""",
    "Peak": """
>>> import numpy as np
>>> from peristalsis import analysis
>>> apart = np.append(np.linspace(0, 1, 50), np.linspace(8, 9, 50))
>>> peak = analysis.two_peaks(apart).upper
>>> round(peak.mean, 2), round(peak.weight, 2)
(8.5, 0.5)
""",
    "NearestFit": """
>>> import numpy as np
>>> from peristalsis import analysis
>>> width = np.linspace(2.4, 2.7, 8)
>>> time = 3.0 * (2.8 - width) ** -1.5
>>> fits = analysis.fit_law_to_nearest("power", width, time, 0.01 * time)
>>> fits[0].widths, round(fits[0].fit.exponent.value, 3)
(4, 1.5)
""",
    "ScatteredLine": """
>>> from peristalsis import analysis
>>> fit = analysis.fit_line_to_scatter([0, 1, 2], [1, 2, 6])
>>> round(fit.line.slope.error, 4), round(fit.determination, 4), fit.linearity
(0.866, 0.8929, None)
""",
    "Estimate": """
>>> from peristalsis import analysis
>>> estimate = analysis.mean_with_error([1.0, 3.0] * 64)
>>> estimate.mean, estimate.samples
(2.0, 128)
""",
    "SurvivalStep": """
>>> from peristalsis import analysis
>>> step = analysis.Survival([1.0, 2.0, 3.0], [True, False, True]).steps[0]
>>> step.time, step.at_risk, round(step.survival.value, 3)
(1.0, 3, 0.667)
""",
}


def examples() -> dict[str, str]:
    """Examples by class: that of the first function or method that answers it or a list of them, where there is none above."""
    found: dict[str, str] = {}
    for path in sorted(OUT.parent.glob("_*.py")):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.FunctionDef) and node.returns:
                name = ast.unparse(node.returns).removeprefix("list[").removesuffix("]")
                _, _, example = (ast.get_docstring(node) or "").partition("Examples\n--------\n")
                found.setdefault(name, example)
    return found | EXAMPLES


def lines(name: str, schema: Mapping[str, Any], example: str) -> Iterator[str]:
    """A class."""

    def indented(words: str, by: int) -> str:
        margin = " " * by
        return textwrap.fill(words, 120, initial_indent=margin, subsequent_indent=margin) + "\n"

    head, *more = plain(schema["description"]).split("\n\n")
    yield f"\n\n@dataclass(frozen=True)\nclass {name}:\n" + indented(f'"""{head}', 4)
    for words in more:
        yield "\n" + indented(words, 4)
    yield "\n    Attributes\n    ----------\n"
    fields = [(field, kind_of(of_field, "tuple[{}, ...]", "dict[str, Any]"), of_field) for field, of_field, _ in parts(schema)]
    for field, kind, of_field in fields:
        yield f"    {field} : {kind}\n" + indented(plain(of_field["description"]), 8)
    yield "\n    Examples\n    --------\n" + textwrap.indent(example.strip(), "    ") + '\n    """\n\n'
    yield from (f"    {field}: {kind}\n" for field, kind, _ in fields)
    yield METHODS.get(name, "")


def text() -> str:
    """The whole file."""
    schemas, example = json.loads(_core.results_schema()), examples()
    return HEAD + "".join(line for name, schema in schemas.items() for line in lines(name, schema, example[name]))


if __name__ == "__main__":
    OUT.write_text(text(), encoding="utf-8")
    print(OUT, file=sys.stderr)
