"""Which joint is which, by the shape of the tree alone: two legs and a spine leave the hips, two arms and a head the
chest.

Limbs come in pairs: of the branches at a joint, the two that are most alike, bone by bone, are the limbs, and the third
is the trunk. Left and right, which a tree does not tell, are read from where the toes point.
"""

from __future__ import annotations

from itertools import combinations, permutations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def children_of(parents: NDArray[np.integer]) -> list[list[int]]:
    """The children of every joint."""
    children: list[list[int]] = [[] for _ in parents]
    for joint, parent in enumerate(parents):
        if parent >= 0:
            children[parent].append(joint)
    return children


def path(parents: NDArray[np.integer], ancestor: int, joint: int) -> list[int]:
    """The joints from `ancestor` down to `joint`, both included; empty if it is none."""
    way = [joint]
    while way[-1] != ancestor:
        if parents[way[-1]] < 0:
            return []
        way.append(int(parents[way[-1]]))
    return way[::-1]


def common_ancestor(parents: NDArray[np.integer], first: int, second: int) -> int:
    """The lowest joint above both (or one of them); -1 if they hang on different roots."""
    above = {first}
    while (first := int(parents[first])) >= 0:
        above.add(first)
    while second >= 0 and second not in above:
        second = int(parents[second])
    return second


def match_shape(parents: NDArray[np.integer], lengths: Array, places: Array) -> dict[str, int]:
    """`{our joint: source's joint}` for hips, head and limbs, or nothing if the tree is not a person's.

    `lengths` (J,) of the bones that lead to the joints; `places` (J, 3) of the joints in some frame or at rest.
    """
    children = children_of(parents)
    reach = _reach(parents, lengths)
    pairs = {
        joint: pair
        for joint, below in enumerate(children)
        if len(below) >= 2 and (pair := _pair(children, lengths, reach, below)) is not None
    }
    likely = sorted(pairs, key=lambda joint: -float(reach[joint]))[:24]
    pairs = {joint: pairs[joint] for joint in likely}
    best: tuple[float, dict[str, int]] = (np.inf, {})
    for (hips, legs), (chest, arms) in permutations(pairs.items(), 2):
        trunk = common_ancestor(parents, hips, chest)
        if trunk < 0 or any(path(parents, leg, chest) for leg in legs[1]) or path(parents, chest, hips):
            continue
        found = _name_limbs(children, lengths, reach, places, hips, legs[1], chest, arms[1])
        way = len(path(parents, trunk, chest)) + len(path(parents, trunk, hips))
        score = legs[0] + arms[0] + 0.02 * way + (0 if len(children[chest]) > 2 else 1)
        if found and score < best[0]:
            best = score, found
    return best[1]


def _reach(parents: NDArray[np.integer], lengths: Array) -> Array:
    """(J,) the longest way from a joint's parent to a leaf below it."""
    reach = lengths.copy()
    for joint in range(len(parents) - 1, -1, -1):
        if parents[joint] >= 0:
            parent = parents[joint]
            reach[parent] = max(reach[parent], lengths[parent] + reach[joint])
    return reach


def _limb(children: list[list[int]], reach: Array, joint: int) -> list[int]:
    """The longest way from a joint to a leaf."""
    way = [joint]
    while children[way[-1]]:
        way.append(max(children[way[-1]], key=lambda child: float(reach[child])))
    return way


def _pair(
    children: list[list[int]], lengths: Array, reach: Array, branches: list[int]
) -> tuple[float, tuple[int, int]] | None:
    """The two branches most alike, long ones if several are, with how unlike they are; None if no two are."""
    best: tuple[float, tuple[int, int]] | None = None
    longest = max(float(reach[branch]) for branch in branches)
    if longest < 0.3 * float(reach.max()):
        return None  # fingers
    limbs = {branch: _limb(children, reach, branch) for branch in branches}
    for a, b in combinations(branches, 2):
        ways = limbs[a], limbs[b]
        if min(len(way) for way in ways) < 3 or abs(len(ways[0]) - len(ways[1])) > 1 or longest <= 0:
            continue
        unlike = sum(abs(lengths[i] - lengths[j]) for i, j in zip(*ways, strict=False)) / longest
        short = 1 - min(reach[a], reach[b]) / longest
        if unlike < 0.25 and (best is None or unlike + short < best[0]):
            best = float(unlike + short), (a, b)
    return best


def _name_limbs(
    children: list[list[int]],
    lengths: Array,
    reach: Array,
    places: Array,
    hips: int,
    legs: tuple[int, int],
    chest: int,
    arms: tuple[int, int],
) -> dict[str, int]:
    limbs = [_bones(_limb(children, reach, joint), lengths) for joint in (*legs, *arms)]
    if any(len(limb) < 3 for limb in limbs) or _length(limbs[0], lengths) < _length(limbs[2], lengths):
        return {}  # legs are longer than arms
    necks = [joint for joint in children[chest] if joint not in arms]
    head = _head(children, max(necks, key=lambda joint: float(reach[joint]))) if necks else chest
    up = places[chest] - places[hips]
    toes = sum(places[leg[min(3, len(leg) - 1)]] - places[leg[2]] for leg in limbs[:2])
    left = np.cross(up, toes)
    found = {"Hips": hips, **({"Head": head} if necks else {})}
    for pair, parts in ((limbs[:2], ("UpLeg", "Leg", "Foot", "ToeBase")), (limbs[2:], ("Arm", "ForeArm", "Hand"))):
        first_is_left = float((places[pair[0][0]] - places[pair[1][0]]) @ left) > 0
        for limb, side in zip(pair, ("Left", "Right") if first_is_left else ("Right", "Left"), strict=True):
            found.update({side + part: joint for part, joint in zip(parts, limb, strict=False)})
    return found


def _head(children: list[list[int]], neck: int) -> int:
    """The end of the neck: the first joint from which face or hair branch, or the last of all."""
    while len(children[neck]) == 1:
        neck = children[neck][0]
    return neck


def _length(limb: list[int], lengths: Array) -> float:
    """Of thigh and shin, or of upper arm and forearm."""
    return float(lengths[limb[1]] + lengths[limb[2]])


def _bones(limb: list[int], lengths: Array) -> list[int]:
    """The limb from the joint above its two long bones: thigh and shin, upper arm and forearm.

    A collar bone and an upper arm can be as long as an upper arm and a forearm: the last such pair is meant.
    """
    pairs = np.array([lengths[limb[i + 1]] + lengths[limb[i + 2]] for i in range(len(limb) - 2)])
    if not len(pairs):
        return []
    return limb[int(np.flatnonzero(pairs >= 0.85 * pairs.max())[-1]) :]
