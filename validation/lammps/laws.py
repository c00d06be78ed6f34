"""Contact laws that both programs know, each in the words of both."""

from __future__ import annotations

import math
from dataclasses import dataclass

POISSON_RATIO = 0.5
# Grains have mass and diameter 1: two of them have the reduced mass 1/2 and the reduced radius 1/4.
REDUCED_MASS, REDUCED_RADIUS = 0.5, 0.25


@dataclass(frozen=True)
class Friction:
    """A tangential spring that slides, one coefficient for static and sliding friction.

    f_t = -k_t u, cut to mu f_n, where u = -f_t/k_t from then on. A tangential dashpot has no common form: that of LAMMPS
    is a multiple of the normal one.
    """

    stiffness: float
    coefficient: float


@dataclass(frozen=True)
class Rolling:
    """A spring in the rolling plane that slides at mu_r f_n; without a dashpot, which cuts the spring otherwise in LAMMPS."""

    stiffness: float
    coefficient: float


@dataclass(frozen=True)
class Linear:
    """f_n = k xi - eta v_n, k = 1."""

    damping: float
    friction: Friction | None = None
    rolling: Rolling | None = None

    @property
    def is_plain(self) -> bool:
        """Whether the method of order 4 knows it."""
        return self.rolling is None

    def settings(self) -> dict[str, object]:
        """Keys of our configuration."""
        law: dict[str, object] = {"contact.law": "linear", "contact.normal_damping": self.damping}
        return law | _friction_settings(self.friction) | _rolling_settings(self.rolling)

    def commands(self) -> list[str]:
        """LAMMPS: `gran/hooke` multiplies its damping by the reduced mass, `granular` with damping `velocity` does not."""
        if self.friction is None:
            return [f"pair_style gran/hooke 1.0 0.0 {self.damping / REDUCED_MASS!r} 0.0 0.0 0", "pair_coeff * *"]
        return ["pair_style granular", f"pair_coeff * * hooke 1.0 {self.damping!r} damping velocity {_tangential(self.friction)}{_rolling(self.rolling)}"]


@dataclass(frozen=True)
class Hertz:
    """f_n = K sqrt(R) (xi^(3/2) - B sqrt(xi) v_n), never negative; K = 2 Y/(3 (1 - nu^2)), Y = 1, nu = 1/2.

    With cohesion of one kind, and then without damping, which LAMMPS does not cut: a constant pull of 4 R f_c in contact
    (Derjaguin, Mueller and Toporov), or the adhesion of Johnson, Kendall and Roberts, which in LAMMPS breaks at the pull-off
    force: `pull_off` is ours alone.
    """

    relaxation_time: float
    friction: Friction | None = None
    rolling: Rolling | None = None
    cohesion_force: float = 0.0
    surface_energy: float = 0.0
    pull_off: str = "force"

    @property
    def is_plain(self) -> bool:
        return self.rolling is None and not self.cohesion_force and not self.surface_energy

    @property
    def modulus(self) -> float:
        return 2 / (3 * (1 - POISSON_RATIO**2))

    def settings(self) -> dict[str, object]:
        necks: dict[str, object] = {"contact.pull_off": self.pull_off} if self.surface_energy else {}
        return {
            "contact.law": "hertz",
            "contact.young_modulus": 1.0,
            "contact.poisson_ratio": POISSON_RATIO,
            "contact.dissipation_form": "printed",
            "contact.dissipation_time": self.relaxation_time,
            "contact.cohesion_force": self.cohesion_force,
            "contact.surface_energy": self.surface_energy,
        } | necks | _friction_settings(self.friction) | _rolling_settings(self.rolling)

    def commands(self) -> list[str]:
        """LAMMPS: damping `viscoelastic` is gamma m_ij sqrt(R xi); `limit_damping` cuts the force at 0.

        `dmt` and `jkr` take the modulus, no damping here, Poisson's ratio and the surface energy: half the work of adhesion.
        """
        gamma = self.modulus * self.relaxation_time / REDUCED_MASS
        tangential = "tangential linear_nohistory 0.0 0.0" if self.friction is None else _tangential(self.friction)
        if self.cohesion_force or self.surface_energy:
            name, energy = ("jkr", self.surface_energy) if self.surface_energy else ("dmt", self.cohesion_force / math.pi)
            law = f"{name} 1.0 0.0 {POISSON_RATIO!r} {energy!r} damping viscoelastic {tangential}{_rolling(self.rolling)}"
            return ["pair_style granular", f"pair_coeff * * {law}"]
        law = f"hertz {self.modulus!r} {gamma!r} damping viscoelastic {tangential}{_rolling(self.rolling)} limit_damping"
        return ["pair_style granular", f"pair_coeff * * {law}"]


Law = Linear | Hertz


def _friction_settings(friction: Friction | None) -> dict[str, object]:
    if friction is None:
        return {"contact.static_friction": 0.0}
    return {
        "contact.static_friction": friction.coefficient,
        "contact.kinetic_friction": friction.coefficient,
        "contact.tangential_stiffness": friction.stiffness,
        "contact.tangential_damping": 0.0,
        "contact.sliding": "balance",
    }


def _tangential(friction: Friction) -> str:
    return f"tangential linear_history {friction.stiffness!r} 0.0 {friction.coefficient!r}"


def _rolling_settings(rolling: Rolling | None) -> dict[str, object]:
    if rolling is None:
        return {}
    return {
        "contact.rolling_friction": rolling.coefficient,
        "contact.rolling_stiffness": rolling.stiffness,
        "contact.rolling_damping": 0.0,
    }


def _rolling(rolling: Rolling | None) -> str:
    return "" if rolling is None else f" rolling sds {rolling.stiffness!r} 0.0 {rolling.coefficient!r}"
