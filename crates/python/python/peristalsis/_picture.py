"""Pictures of a simulation."""

from __future__ import annotations

import os
from pathlib import Path


class Picture:
    """A picture in PNG, which a notebook shows.

    Attributes
    ----------
    png : bytes
        The file; ``matplotlib.pyplot.imread(io.BytesIO(picture.png))`` or Pillow make an array of it.

    Examples
    --------
    >>> import peristalsis
    >>> picture = peristalsis.Simulation.preset("frictionless", waves=2).render(width=200)
    >>> picture.png[1:4]
    b'PNG'
    """

    __slots__ = ("png",)

    def __init__(self, png: bytes) -> None:
        self.png: bytes = png

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the PNG to a file.

        Parameters
        ----------
        path : path
            The file, over an older one.

        Examples
        --------
        >>> import tempfile
        >>> from pathlib import Path
        >>> import peristalsis
        >>> picture = peristalsis.Simulation.preset("frictionless", waves=2, strain_rate=0.03).render(width=200)
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     picture.save(Path(folder) / "tube.png")
        """
        Path(path).write_bytes(self.png)

    def __bytes__(self) -> bytes:
        return self.png

    def _repr_png_(self) -> bytes:
        return self.png

    def __repr__(self) -> str:
        width, height = (int.from_bytes(self.png[at : at + 4], "big") for at in (16, 20))
        return f"<peristalsis.Picture: {width} x {height} pixels>"
