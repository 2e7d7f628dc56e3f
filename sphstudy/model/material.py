"""Hooke's law in two dimensions: plane strain and plane stress."""

from typing import NamedTuple


class Material(NamedTuple):
    """Isotropic linear elastic solid: Young's modulus (Pa), Poisson's ratio, density (kg/m³)."""

    youngs_modulus: float
    poisson_ratio: float
    density: float
    plane: str
    """"strain" or "stress"."""

    @property
    def shear_modulus(self) -> float:
        """G = E / (2 (1 + ν)) [Pa]."""
        return self.youngs_modulus / (2.0 * (1.0 + self.poisson_ratio))

    @property
    def bulk_modulus(self) -> float:
        """K = E / (3 (1 - 2ν)) [Pa], from E and ν as given, in plane stress too."""
        return self.youngs_modulus / (3.0 * (1.0 - 2.0 * self.poisson_ratio))

    @property
    def wave_speed(self) -> float:
        """c0 = √(K/ρ0) (2.22) [m/s]."""
        return (self.bulk_modulus / self.density) ** 0.5

    @property
    def lame_modulus(self) -> float:
        """λ of the stress in the plane, σ = λ tr(ε) I + 2Gε [Pa].

        Plane strain: Eν/((1+ν)(1-2ν)); plane stress: Eν/(1-ν²), which is the same formula with the
        thesis's E' = E(1+2ν)/(1+ν)² and ν' = ν/(1+ν).
        """
        e, nu = self.youngs_modulus, self.poisson_ratio
        if self.plane == "stress":
            return e * nu / (1.0 - nu**2)
        return e * nu / ((1.0 + nu) * (1.0 - 2.0 * nu))

    @property
    def primed(self) -> tuple[float, float]:
        """(E', ν') = (E(1+2ν)/(1+ν)², ν/(1+ν)): in the plane strain law they make plane stress."""
        e, nu = self.youngs_modulus, self.poisson_ratio
        return e * (1.0 + 2.0 * nu) / (1.0 + nu) ** 2, nu / (1.0 + nu)

    @property
    def compliance(self) -> tuple[float, float]:
        """(E*, ν*) with which the strains are ε_xx = (σ_xx - ν* σ_yy)/E*, ε_xy = (1 + ν*) σ_xy/E*.

        Plane stress: E and ν themselves (3.19 to 3.21); plane strain: E/(1-ν²), ν/(1-ν).
        """
        e, nu = self.youngs_modulus, self.poisson_ratio
        if self.plane == "stress":
            return e, nu
        return e / (1.0 - nu**2), nu / (1.0 - nu)
