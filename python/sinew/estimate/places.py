"""Localisation of a force on the surface of a body: patches and their probabilities."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Optional

import numpy as np
import scipy.special

from .. import _core
from ..errors import Error, RunError
from .quantities import NodalForce
from .response import Response
from .static import Estimate, solve
from .twin import Twin

__all__ = ["Patch", "Search", "locate", "patches"]

_FACES = {4: ((0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)),
          8: ((0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7))}
_ROUNDS = 200


@dataclass(frozen=True)
class Patch:
    """A patch of a body's surface.

    Attributes
    ----------
    body : str
    centre, normal : (3,) ndarray
        Centre of area (m) and mean outward unit normal, at rest.
    triangles : (k, 3) ndarray of int
        Nodes.
    shares : (k,) ndarray
        Fraction of the area of each triangle, sum 1.
    nodes, weights : (n,) ndarray
        Nodes, and a third of the area of the triangles around each, as a fraction of the total.
    area : float
        m^2 at rest.
    neighbours : tuple of int
        Indices of the patches that share a node with it.
    """

    body: str
    centre: np.ndarray
    normal: np.ndarray
    triangles: np.ndarray
    shares: np.ndarray
    nodes: np.ndarray
    weights: np.ndarray
    area: float
    neighbours: tuple[int, ...]


def surface(sim: _core.Simulation, body: str) -> np.ndarray:
    """(k, 3) nodes of the triangles of a body's surface, oriented outwards, without triangles that have a fixed node.

    Raises
    ------
    Error
        wrong-type for bodies without finite elements.
    """
    shown = sim.body(body)
    quadratic = np.asarray(shown.quadratic_tetrahedra).reshape(-1, 10)[:, :4]
    cells = [np.asarray(shown.tetrahedra).reshape(-1, 4), quadratic, np.asarray(shown.hexahedra).reshape(-1, 8)]
    faces: dict[tuple[int, ...], tuple[int, ...]] = {}
    for of_kind in cells:
        for cell in of_kind.tolist():
            for corners in _FACES[len(cell)]:
                face = tuple(cell[c] for c in corners)
                key = tuple(sorted(face))
                if faces.pop(key, None) is None:
                    faces[key] = face
    if not faces:
        raise Error("wrong-type", f"body('{body}')", "it has no solid finite elements, and no surface to search",
                    "name another body")
    found = np.array([[face[0], face[k], face[k + 1]] for face in faces.values() for k in range(1, len(face) - 1)])
    return found[~np.asarray(shown.fixed)[found].any(axis=1)]


def patches(sim: _core.Simulation, body: str, count: int = 48) -> list[Patch]:
    """Divides the free surface of a body into patches of about equal area, by Lloyd's iteration on the triangle centres.

    The iteration starts from triangles that are far from each other, so the patches of a body are always the same.

    Parameters
    ----------
    sim : sinew.Simulation
    body : str
        A body of finite elements.
    count : int
        Number of patches, >= 2.

    Raises
    ------
    Error
        wrong-type, out-of-range.
    """
    triangles, rest = surface(sim, body), np.array(sim.body(body).rest_positions)
    if not 2 <= count <= len(triangles):
        raise Error("out-of-range", "patches(count)", f"{count} patches of {len(triangles)} triangles",
                    f"give 2 to {len(triangles)}")
    corners = rest[triangles]
    normals = 0.5 * np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    areas, centres = np.linalg.norm(normals, axis=1), corners.mean(axis=1)
    # The normal, scaled by half a patch width, is part of the features: it separates the two sides of a thin body.
    width = math.sqrt(areas.sum() / count)
    features = np.hstack([centres, 0.5 * width * normals / areas[:, None]])
    label = _cluster(features, areas, count)
    groups = [np.flatnonzero(label == k) for k in range(count)]
    nodes = [set(triangles[group].ravel().tolist()) for group in groups]
    made = []
    for k, group in enumerate(groups):
        shares = np.zeros(len(rest))
        np.add.at(shares, triangles[group].ravel(), np.repeat(areas[group] / 3.0, 3))
        own = np.flatnonzero(shares)
        normal = normals[group].sum(axis=0)
        made.append(Patch(body, np.average(centres[group], axis=0, weights=areas[group]), normal / np.linalg.norm(normal),
                          triangles[group], areas[group] / areas[group].sum(), own, shares[own] / shares.sum(),
                          float(areas[group].sum()),
                          tuple(j for j in range(count) if j != k and nodes[j] & nodes[k])))
    return made


def _cluster(features: np.ndarray, weights: np.ndarray, count: int) -> np.ndarray:
    seeds = [int(np.argmax(features[:, 2]))]
    distance = np.full(len(features), np.inf)
    while len(seeds) < count:
        distance = np.minimum(distance, ((features - features[seeds[-1]])**2).sum(axis=1))
        seeds.append(int(np.argmax(distance)))
    centres, label = features[seeds].copy(), None
    for _ in range(_ROUNDS):
        before, label = label, ((features[:, None] - centres)**2).sum(axis=2).argmin(axis=1)
        if before is not None and (before == label).all():
            break
        for k in range(count):
            inside = label == k
            if inside.any():
                centres[k] = np.average(features[inside], axis=0, weights=weights[inside])
    return label


@dataclass(frozen=True)
class Search:
    """Result of locate().

    Attributes
    ----------
    status : str
        "found"; "ambiguous": no patch has the required probability; "unexplained": the best location does not explain the
        readings; "unobservable": the prior dominates the readings there; "no-force": the readings are as likely without a
        force.
    patch : int
        Index of the most probable patch.
    probability : (patches,) ndarray
        Posterior, with prior probabilities proportional to area; sums to 1.
    log_evidence : (patches,) ndarray
        log p(readings | a force somewhere on the patch).
    solved : list of int
        Patches with a nonlinear equilibrium of their own, most probable first; the others are linearised.
    place : (3,) ndarray
        Most probable point, m at rest.
    force : (3,) ndarray
        Force at this point, N, in world axes.
    estimate : Estimate
        Estimate at this point, with the unknowns "touch.0" (inward normal force), "touch.1" and "touch.2" (tangential).
    """

    status: str
    patch: int
    probability: np.ndarray
    log_evidence: np.ndarray
    solved: list[int]
    place: np.ndarray
    force: np.ndarray
    estimate: Estimate

    def likely(self, share: float = 0.9) -> list[int]:
        """The smallest set of patches that contains the force with this probability, most probable first."""
        order = np.argsort(-self.probability, kind="stable")
        return order[:int(np.searchsorted(np.cumsum(self.probability[order]), share)) + 1].tolist()


# Centroids of the four quarters of a triangle, as weights of its corners.
_QUARTERS = np.array([[4, 1, 1], [1, 4, 1], [1, 1, 4], [2, 2, 2]]) / 6.0


@dataclass(frozen=True)
class _State:
    """The model in equilibrium with one force on it, or none."""

    estimate: Estimate
    evidence: np.ndarray  # (points,) log p(readings | point)
    forces: np.ndarray  # (points, 3) posterior means of the linearised model


class _Locator:
    """Candidate points on all patches, each with a prior of the force that may act there."""

    def __init__(self, twin: Twin, readings: Mapping[str, Any], areas: Sequence[Patch], prior: float, friction: float) -> None:
        self.twin, self.readings, self.areas = twin, readings, list(areas)
        self.prior, self.friction = prior, friction
        self.body = areas[0].body
        self.nodes = np.repeat(np.concatenate([a.triangles for a in areas]), len(_QUARTERS), axis=0)
        self.weights = np.tile(_QUARTERS, (len(self.nodes) // len(_QUARTERS), 1))
        self.patch = np.concatenate([np.full(len(_QUARTERS) * len(a.triangles), k) for k, a in enumerate(areas)])
        self.share = np.concatenate([np.repeat(a.shares, len(_QUARTERS)) for a in areas]) / len(_QUARTERS)  # fraction of the patch's area
        area = np.array([a.area for a in areas])
        self.log_prior = np.log(area / area.sum())  # of each patch
        self.frames = np.array([_frame(a.normal) for a in areas])

    def force(self, point: int, normal: float) -> NodalForce:
        """Unknown force at a point; its tangential standard deviation is proportional to the expected normal force."""
        tangent = self.friction * max(abs(normal), 1e-3 * self.prior)
        return NodalForce("touch", self.body, self.nodes[point], self.weights[point], prior=(self.prior, tangent, tangent),
                          directions=self.frames[self.patch[point]])

    def model(self, point: Optional[int], normal: float = 0.0) -> Twin:
        return self.twin.with_unknowns([*self.twin.unknowns, *([] if point is None else [self.force(point, normal)])])

    def solve(self, point: Optional[int], force: np.ndarray, start: Optional[np.ndarray]) -> _State:
        """Nonlinear estimate with a force at a point, and all candidates linearised about it."""
        model, at = self.model(point, force[0]), self.twin.asked
        if start is not None:
            start = np.concatenate([start[:at], force, start[at:]])
        estimate = solve(model, self.readings, start=start)
        found = estimate.unknowns[at:at + 3] if point is not None else np.zeros(3)
        evidence, forces = self._rank(model, estimate, point, found)
        return _State(estimate, evidence, forces)

    def known(self, state: _State, point: Optional[int]) -> np.ndarray:
        """Unknowns other than the force."""
        at = self.twin.asked
        values = state.estimate.unknowns
        return values if point is None else np.concatenate([values[:at], values[at + 3:]])

    # Evidence and force of every point from y ~ N(h + J_o (mean_o - o) + S f, R + J_o P_o J_o^T), with a force f there instead of
    # the present one and the other unknowns o.
    def _rank(self, model: Twin, estimate: Estimate, point: Optional[int], force: np.ndarray):
        numbers, commands = self.twin.split(self.readings)
        seen = np.isfinite(numbers)
        response = Response(model.sim, model.sim.linearise(fields=True))
        field = model.nodal_columns(response, self.body)  # (rows, n, 3)
        at = np.einsum("rpkc,pk,pdc->rpd", field[:, self.nodes], self.weights, self.frames[self.patch])
        motions, efforts = response.to_columns(at.reshape(len(at), -1))
        columns = model.rows_to_outputs(motions, efforts, response).reshape(len(numbers), -1, 3)[seen]  # (m, points, 3)
        mean, std = model.prior(commands)
        sensitivity = model.sensitivity(estimate.unknowns)[seen]
        rest = np.ones(len(mean), bool)
        if point is not None:
            rest[self.twin.asked:self.twin.asked + 3] = False
        residual = numbers[seen] - model.read()[seen] - sensitivity[:, rest] @ (mean - estimate.unknowns)[rest]
        if point is not None:
            residual = residual + columns[:, point] @ force
        spread = sensitivity[:, rest] * std[rest]
        lower = np.linalg.cholesky(np.diag(model.noise[seen]**2) + spread @ spread.T)
        whitened = np.linalg.solve(lower, columns.reshape(len(lower), -1)).reshape(columns.shape)
        constant = -np.log(np.diag(lower)).sum() - 0.5 * len(lower) * math.log(2.0 * math.pi)
        evidence, forces = self._evidence(whitened, np.linalg.solve(lower, residual))
        return constant + evidence, forces

    # log N(r; 0, I + A P A^T) of each point by Woodbury's identity, plus the log probability that the force pushes.
    def _evidence(self, columns: np.ndarray, residual: np.ndarray):
        gram = np.einsum("mpc,mpd->pcd", columns, columns)
        answer = np.einsum("mpc,m->pc", columns, residual)
        tangent = np.full(len(gram), self.friction * self.prior)
        for _ in range(3):  # the friction prior depends on the normal force
            std = np.column_stack([np.full(len(gram), self.prior), tangent, tangent])
            information = gram + np.eye(3) * (std**-2.0)[:, None, :]
            force = np.linalg.solve(information, answer[..., None])[..., 0]
            tangent = self.friction * np.maximum(np.abs(force[:, 0]), 1e-3 * self.prior)
        variance = np.linalg.inv(information)[:, 0, 0]
        evidence = (-0.5 * residual @ residual + 0.5 * (answer * force).sum(axis=1)
                    - 0.5 * np.linalg.slogdet(information)[1] - np.log(std).sum(axis=1))
        return evidence + scipy.special.log_ndtr(force[:, 0] / np.sqrt(variance)) + math.log(2.0), force

    def of_patches(self, evidence: np.ndarray) -> np.ndarray:
        """(patches,) log p(readings | patch), the mean over its area."""
        return np.array([scipy.special.logsumexp(evidence[self.patch == k], b=self.share[self.patch == k])
                         for k in range(len(self.areas))])

    def best_point(self, evidence: np.ndarray, patch: Optional[int] = None) -> int:
        inside = evidence if patch is None else np.where(self.patch == patch, evidence, -math.inf)
        return int(np.argmax(inside))


def _frame(normal: np.ndarray) -> np.ndarray:
    """(3, 3) rows: inward normal, two tangents."""
    tangent = np.cross(normal, np.eye(3)[np.argmin(np.abs(normal))])
    tangent /= np.linalg.norm(tangent)
    return np.array([-normal, tangent, np.cross(normal, tangent)])


def locate(twin: Twin, readings: Mapping[str, Any], areas: Sequence[Patch], *, prior: float = 1.0, friction: float = 0.3,
           candidates: int = 6, probability: float = 0.5, significance: float = 1e-3) -> Search:
    """Locates and estimates an unknown pushing force on a body, with probabilities.

    One factorisation gives the columns of all points of the surface (Linearisation.fields): by reciprocity, the motion of all
    nodes for unit efforts of the measured rows is the response of these rows to a force on any node. The evidence of a point
    is that of the linear model with a Gaussian force, N(y; h, R + S P S^T) (MacKay, Information Theory, CUP 2003, ch. 28); that
    of a patch is its mean over the area. The best point is solved with the nonlinear equilibrium and all others are ranked
    again about this solution, until the best one no longer changes. Then the best point of each likely patch is solved, and its
    patch is ranked about it. A push has an inward normal force, so points at which the force would have to pull are unlikely.

    Parameters
    ----------
    twin : Twin
        Measurement model; the force is added to its unknowns. Its readings must be rows.
    readings : dict of str to float or array_like
    areas : list of Patch
        Patches of one body, with prior probabilities proportional to area.
    prior : float
        Standard deviation of the normal force, N.
    friction : float
        Standard deviation of each tangential force divided by the normal force.
    candidates : int
        Number of patches to solve nonlinearly.
    probability : float
        Required probability of the best patch; below it the status is "ambiguous".
    significance : float
        Significance of chi squared at the best patch; below it the status is "unexplained".

    Returns
    -------
    Search

    Raises
    ------
    Error
        As solve(); wrong-type for bodies without finite elements, bad-argument for readings that are not rows.
    RunError
        not-converged if there is no equilibrium at any location.
    """
    if not twin.is_linear_in_rows:
        raise Error("bad-argument", "locate()", "readings of this model are not rows, or follow drives and friction of cables",
                    "measure markers, lengths and tensions, or give the place: Force")
    locator = _Locator(twin, readings, areas, prior, friction)
    base = locator.solve(None, np.zeros(3), None)
    point, state = _climb(locator, base)
    evidence = locator.of_patches(state.evidence)
    states = {int(locator.patch[point]): (point, state)}
    for k in np.argsort(-(evidence + locator.log_prior), kind="stable")[:candidates].tolist():
        if k not in states:
            tried = _try(locator, locator.best_point(state.evidence, k), state, point)
            if tried is not None:
                states[k] = tried
    for k, (_, own) in states.items():
        evidence[k] = locator.of_patches(own.evidence)[k]
    return _judge(locator, base, states, evidence, probability, significance)


def _try(locator: _Locator, point: int, state: _State, before: Optional[int]) -> Optional[tuple[int, _State]]:
    try:
        return point, locator.solve(point, state.forces[point], locator.known(state, before))
    except RunError:
        return None


def _climb(locator: _Locator, base: _State) -> tuple[int, _State]:
    """Moves to the best point of each linearisation, until that is the point itself or one visited before."""
    state, at, seen = base, None, {}
    for _ in range(8):
        order = np.argsort(-state.evidence, kind="stable")
        point = int(order[0])
        if point in seen:
            break
        tried = _try(locator, point, state, at)
        if tried is None and at is None:  # there is no equilibrium under the linear force: start with a smaller one
            tried = _try_less(locator, point, state)
        if tried is None:
            break
        at, state = tried
        seen[at] = state
    if not seen:
        raise RunError("not-converged", "locate()", "no place of a force has an equilibrium near the readings",
                       "check commands and readings, or tighten the prior")
    best = max(seen, key=lambda k: seen[k].evidence[k])
    return best, seen[best]


def _try_less(locator: _Locator, point: int, state: _State) -> Optional[tuple[int, _State]]:
    try:
        return point, locator.solve(point, 0.2 * state.forces[point], locator.known(state, None))
    except RunError:
        return None


def _judge(locator: _Locator, base: _State, states: dict, evidence: np.ndarray, probability: float, significance: float) -> Search:
    posterior = evidence + locator.log_prior
    posterior = np.exp(posterior - scipy.special.logsumexp(posterior))
    best = max(states, key=lambda k: posterior[k])
    point, state = states[best]
    estimate, at = state.estimate, locator.twin.asked
    model = locator.model(point, estimate.unknowns[at])
    model.predict(estimate.unknowns)
    status = "found"
    if estimate.probability < significance:
        status = "unexplained"
    elif estimate.observability.singular_values[0] < 1.0:
        status = "unobservable"
    elif base.estimate.log_evidence > scipy.special.logsumexp(evidence + locator.log_prior):
        status = "no-force"
    elif posterior[best] < probability or best != int(np.argmax(posterior)):
        status = "ambiguous"
    rest = np.array(model.sim.body(locator.body).rest_positions)
    return Search(status, best, posterior, evidence, sorted(states, key=lambda k: -posterior[k]),
                  locator.weights[point] @ rest[locator.nodes[point]],
                  estimate.unknowns[at:at + 3] @ locator.frames[best], estimate)
