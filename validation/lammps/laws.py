"""Contact laws that both programs know, each in the words of both."""

from __future__ import annotations

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
class Linear:
    """f_n = k xi - eta v_n, k = 1."""

    damping: float
    friction: Friction | None = None

    def settings(self) -> dict[str, object]:
        """Keys of our configuration."""
        return {"contact.law": "linear", "contact.normal_damping": self.damping} | _friction_settings(self.friction)

    def commands(self) -> list[str]:
        """LAMMPS: `gran/hooke` multiplies its damping by the reduced mass, `granular` with damping `velocity` does not."""
        if self.friction is None:
            return [f"pair_style gran/hooke 1.0 0.0 {self.damping / REDUCED_MASS!r} 0.0 0.0 0", "pair_coeff * *"]
        return ["pair_style granular", f"pair_coeff * * hooke 1.0 {self.damping!r} damping velocity {_tangential(self.friction)}"]


@dataclass(frozen=True)
class Hertz:
    """f_n = K sqrt(R) (xi^(3/2) - B sqrt(xi) v_n), never negative; K = 2 Y/(3 (1 - nu^2)), Y = 1, nu = 1/2."""

    relaxation_time: float
    friction: Friction | None = None

    @property
    def modulus(self) -> float:
        return 2 / (3 * (1 - POISSON_RATIO**2))

    def settings(self) -> dict[str, object]:
        return {
            "contact.law": "hertz",
            "contact.young_modulus": 1.0,
            "contact.poisson_ratio": POISSON_RATIO,
            "contact.dissipation_form": "printed",
            "contact.dissipation_time": self.relaxation_time,
        } | _friction_settings(self.friction)

    def commands(self) -> list[str]:
        """LAMMPS: damping `viscoelastic` is gamma m_ij sqrt(R xi); `limit_damping` cuts the force at 0."""
        gamma = self.modulus * self.relaxation_time / REDUCED_MASS
        tangential = "tangential linear_nohistory 0.0 0.0" if self.friction is None else _tangential(self.friction)
        law = f"hertz {self.modulus!r} {gamma!r} damping viscoelastic {tangential} limit_damping"
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
