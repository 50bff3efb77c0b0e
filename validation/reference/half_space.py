"""An elastic half space under a point force, compared with a half ball that is fixed at its round border."""

from __future__ import annotations

import numpy as np


def lost_to_the_border(poisson: float, terms: int = 40, points: int = 400) -> float:
    """The coefficient c of the displacement c F/(4 pi G L) by which a half ball of radius L, fixed at its round border, yields
    less under a point force F than the half space, to leading order in the size of the loaded spot over L.

    Boussinesq's displacement at the border (K. L. Johnson, Contact Mechanics, 1985, eq. 3.19) is cancelled by fields
    2 G u = grad(phi + z psi) - 4 (1 - nu) psi e_z (Papkovich, Neuber) of harmonic polynomials h_n = r^n P_n(cos). They leave the
    plane free of traction if phi holds, with every h_n of psi, a_n h_(n+1): a_n = (1 - 2 nu)/(n + 1) for even n and
    2 (1 - nu)/(n + 1) for odd n. At the force only the translation among these fields contributes.
    """
    cosine = np.cos(0.5 * np.pi * (np.arange(points) + 0.5) / points)
    sine = np.sqrt(1.0 - cosine**2)
    harmonic = np.array([np.polynomial.legendre.Legendre.basis(n)(cosine) for n in range(terms + 1)])

    def down(n):
        return n * harmonic[n - 1]

    def outward(n):
        return (n * harmonic[n] - cosine * down(n)) / sine

    fields = [np.concatenate([np.zeros(points), np.ones(points)])]
    for n in range(1, terms):
        share = ((1.0 - 2.0 * poisson) if n % 2 == 0 else 2.0 * (1.0 - poisson)) / (n + 1)
        fields.append(np.concatenate([share * outward(n + 1) + cosine * outward(n),
                                      share * down(n + 1) + cosine * down(n) - (3.0 - 4.0 * poisson) * harmonic[n]]))
    boussinesq = np.concatenate([sine * cosine - (1.0 - 2.0 * poisson) * sine / (1.0 + cosine),
                                 2.0 * (1.0 - poisson) + cosine**2])
    return float(np.linalg.lstsq(np.array(fields).T, boussinesq, rcond=None)[0][0])
