"""Segments of one's own drivers as inputs of jobs: `myclip/happy` stands for the driver, trimmed to that segment."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import NoReturn

from engine.kind import Input, Kind
from service.context import Context
from service.jobs.inputs import Value
from service.libraries import driver_segments
from service.problems import FieldError, Problem

Given = Mapping[str, Value]


def choose_segments(
    context: Context, owner: str, kind: Kind, options: Mapping[str, object], given: Given
) -> Callable[[], tuple[Given, dict[str, object]]]:
    """What is given to a job, with files in place of segments, and its options, with the trims that they set.

    It is looked up at once, since it may lie in the storage, which no transaction should wait for. Calling what is
    returned gives it, or raises a 422 problem: `unknown_driver`, `unknown_moment`, `moments_pending`,
    `portion_and_trim`. So a request that was answered before is answered the same whatever became of the driver.
    """
    try:
        chosen = _chosen(context, owner, kind, options, given)
    except Problem as problem:
        return partial(_refuse, problem)
    return lambda: chosen


def _refuse(problem: Problem) -> NoReturn:
    raise problem


def _chosen(
    context: Context, owner: str, kind: Kind, options: Mapping[str, object], given: Given
) -> tuple[Given, dict[str, object]]:
    meant, trimmed = dict(given), dict(options)
    for item in kind.inputs:
        value = given.get(item.name)
        if item.trimmed_by is None or not isinstance(value, str) or not _names_segment(value):
            continue
        try:
            meant[item.name], trimmed[item.trimmed_by] = _segment(context, owner, item, item.trimmed_by, value, options)
        except Problem as problem:
            error = FieldError(pointer=f"/inputs/{item.name}", code=problem.code, detail=problem.detail)
            raise Problem(problem.status, problem.code, problem.detail, [error]) from problem
    return meant, trimmed


def _names_segment(value: str) -> bool:
    return value.count("/") == 1 and "://" not in value


def _segment(
    context: Context, owner: str, item: Input, option: str, value: str, options: Mapping[str, object]
) -> tuple[str, list[float]]:
    if options.get(option) is not None:
        detail = f"“{item.name}” names a moment of a driver, and “{option}” another: leave one of them out."
        raise Problem(422, "portion_and_trim", detail)
    name, _, segment_name = value.partition("/")
    file_id, segment = driver_segments.segment(context, owner, name, segment_name)
    return file_id, [segment.start, segment.end]
