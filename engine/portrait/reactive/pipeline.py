"""A reactive profile, stage by stage: the target is analysed once, then every state's clip and its bridges are drawn."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from engine.export.still import write_still
from engine.export.videos.encoders import VideoTarget
from engine.export.videos.video import VideoWriter
from engine.face_animation.animation import FaceAnimation, RegisteredDriver, RiggedTarget, draw_in_order
from engine.face_animation.creases.fine_details import RatioStrip
from engine.face_animation.driver_tracking.neutral import NeutralFrame, choose_neutral_frame, warn_if_never_at_rest
from engine.face_animation.face_rig import FaceRig
from engine.face_animation.motion_transfer.control_motion import carry_motion
from engine.face_animation.motion_transfer.head_proxy import build_head_proxy
from engine.face_animation.motion_transfer.landmark_residuals import LandmarkResiduals
from engine.face_animation.stages import (
    DriverPerformance,
    analyse_driver,
    follow_driver,
    prepare_target,
)
from engine.face_animation.target_face import TargetFace
from engine.face_animation.warping.layers import Layers
from engine.kind import Given
from engine.media.video import probe_video
from engine.performances.catalogue import PERFORMANCE_FPS
from engine.portrait.options import PortraitOptions
from engine.portrait.pipeline import STAGES, first_impression, write_landmarks
from engine.portrait.reactive.bridges import HOLD_FRAMES, ExitBridges, PoseDistance, bridge, find_exits, longest_step
from engine.portrait.reactive.bundle import player, write_bundle
from engine.portrait.reactive.document import Profile, StatePart, TransitionPart, TriggerPart
from engine.portrait.reactive.excursion import Pose, excursion
from engine.portrait.reactive.states import IDLE_STATE, State, choose_states, default_triggers
from engine.portrait.target import in_pixels, look_for_face
from engine.run import Run
from engine.run_report import write_report

MAX_PERFORMANCE_SECONDS = 20.0
"""Of a driving video of the user's own: a page loads the clip and all ways out of it."""
PER_DRIVER = ("track_driver", "register_driver", "ratio_images", "glance_at_driver", "look_again", "animate")


@dataclass(frozen=True)
class StatePerformance:
    """One state's performance on the target: its poses, and the ways out of them."""

    state: State
    performance: DriverPerformance
    poses: tuple[Pose, ...]
    exits: ExitBridges
    rest: NDArray[np.float32]

    def bridges(self) -> Iterator[Pose]:
        """The poses of all bridges, one bridge after another."""
        for frame, segment in zip(self.exits.frames, self.exits.segments(), strict=True):
            yield from bridge(self.poses[frame], segment, self.rest)


def make_profile(inputs: Mapping[str, Given], options: PortraitOptions, out: Path, run: Run) -> None:
    """Make `inputs["image"]` react; leaves the artifacts of the contract in `out`. A driver left to be chosen adds
    nothing: the built-in performances are there anyway."""
    image, driver = inputs["image"], inputs.get("driver")
    assert isinstance(image, Path)
    player()  # before anything is worked out
    states = choose_states(options, driver if isinstance(driver, Path) else None)
    run.plan(STAGES, dict.fromkeys(PER_DRIVER, len(states)))
    if options.sound:
        run.warn("profile_is_silent", "A reactive profile has no sound.")
    if without_effect := _without_effect(options, states):
        run.warn("options_without_effect", f"A profile like this has no use for {', '.join(without_effect)}.")
    target = first_impression(look_for_face(image, options, run), out, run)
    prepared = prepare_target(target, run)
    fps = options.fps or float(PERFORMANCE_FPS)
    performances = [_analyse(state, target, fps, options, run) for state in states]
    residuals = [one.residuals_on(prepared, options.acting(), run) for one in performances]
    layers, rig = prepared.layers(), prepared.rig()
    acts = plan_performances(states, performances, residuals, target, rig, options)
    _draw(acts, target, layers, rig, options, fps, out, run)
    profile = _describe(acts, target, fps)
    (out / "profile.json").write_text(profile.model_dump_json(indent=1, exclude_none=True) + "\n")
    write_bundle(out / "profile.zip", out, profile)
    told = performances[-1 if states[-1].own else 0]  # the one whose neutral frame can be chosen, if there is one
    write_landmarks(out / "landmarks.json", target, told.track, told.neutral)
    write_report(
        out / "report.json",
        "portrait",
        run,
        inputs={
            "size": list(target.size),
            "fps": fps,
            "frames": sum(len(act.poses) for act in acts),
            "faces": in_pixels(target.faces),
            "driver_faces": [
                box
                for state, one in zip(states, performances, strict=True)
                if state.own
                for box in in_pixels(one.track.faces)
            ],
            "states": {act.state.name: len(act.poses) for act in acts},
            "bridges": {act.state.name: len(act.exits.frames) for act in acts},
            "animation": options.animation,
        },
        quality={"driver_face_share": float(np.mean(np.concatenate([one.track.found for one in performances])))},
    )


def _without_effect(options: PortraitOptions, states: Sequence[State]) -> list[str]:
    """The options that were chosen and change nothing: built-in performances are played as they are, and every clip
    returns to the rest by itself."""
    of_one_s_own = () if any(state.own for state in states) else ("neutral_frame", "trim", "driver_face_index")
    usual = PortraitOptions.model_fields
    return [name for name in ("loop", *of_one_s_own) if getattr(options, name) != usual[name].default]


def _analyse(state: State, target: TargetFace, fps: float, options: PortraitOptions, run: Run) -> DriverPerformance:
    """A driver's analysis, the same that a portrait driven by it alone would make where the frame rates agree."""
    if not state.own:
        tracking = follow_driver(state.video, options.fps, None, 0, run)
        return analyse_driver(tracking, lambda track: NeutralFrame(round(_frame(state, track.fps)), "chosen"), run)
    trim = options.trim
    if trim is None and probe_video(state.video, run.limits).seconds > MAX_PERFORMANCE_SECONDS:
        trim = (0.0, MAX_PERFORMANCE_SECONDS)
        run.warn(
            "driver_shortened",
            f"The first {MAX_PERFORMANCE_SECONDS:.0f} seconds of the driver are used: trim chooses others.",
        )
    tracking = follow_driver(state.video, fps, trim, options.driver_face_index, run)
    performance = analyse_driver(
        tracking, lambda track: choose_neutral_frame(track, target.mesh, state.neutral_frame), run
    )
    warn_if_never_at_rest(performance.choice, run.warn)
    return performance


def _frame(state: State, fps: float) -> float:
    """The neutral frame of a built-in performance at another frame rate."""
    return (state.neutral_frame or 0) * fps / PERFORMANCE_FPS


def plan_performances(
    states: Sequence[State],
    performances: Sequence[DriverPerformance],
    residuals: Sequence[LandmarkResiduals | None],
    target: TargetFace,
    rig: FaceRig,
    options: PortraitOptions,
) -> list[StatePerformance]:
    """The poses of all states, and the ways out of them, before anything is drawn."""
    proxy = build_head_proxy(rig.control.points, target.mesh) if options.head_3d else None
    poses, rests = [], []
    for state, one, corrected in zip(states, performances, residuals, strict=True):
        motions = list(
            carry_motion(one.track, one.neutral, target.mesh, rig.control, proxy, options.acting(), corrected)
        )
        rests.append(motions[one.neutral].depth)
        poses.append(excursion(motions, rests[-1], one.track.fps, state.loops))
    steps = [longest_step(one, state.loops) for state, one in zip(states, poses, strict=True)]
    pace = PoseDistance(max(step.head for step in steps), max(step.furthest for step in steps))
    return [
        StatePerformance(state, one, acted, find_exits(acted, step, pace), rest)
        for state, one, acted, step, rest in zip(states, performances, poses, steps, rests, strict=True)
    ]


def _draw(
    acts: Sequence[StatePerformance], target: TargetFace, layers: Layers, rig: FaceRig, options: PortraitOptions, fps: float,
    out: Path, run: Run,
) -> None:  # fmt: skip
    """All clips, their bridges, all of it in one animation, and the poster."""
    size = target.size
    mark = run.mark_synthetic
    with VideoWriter(VideoTarget(out / options.animation, size, fps, synthetic=mark)) as whole:
        for act in acts:
            with run.timed("animate"), ExitStack() as files:
                track, neutral, ratios = act.performance.track, act.performance.neutral, act.performance.ratios
                animation = FaceAnimation(
                    RiggedTarget(target, layers, rig), RegisteredDriver(track, neutral), options.acting()
                )
                name = out / clip_name(act.state)
                clip = files.enter_context(VideoWriter(VideoTarget(name, size, fps, entries=(0,), synthetic=mark)))
                segments = act.exits.segments()
                total = len(act.poses) + sum(one.opens + one.length + HOLD_FRAMES for one in segments)
                done = 0
                for frame in draw_in_order(animation.draw, _with_ratios(act.poses, ratios)):
                    if done == 0 and act.state.name == IDLE_STATE:
                        write_still(out / "poster.jpg", frame, mark)
                    clip.write(frame)
                    whole.write(frame)
                    done += 1
                    run.tick(done / total, f"{act.state.name}: frame {done} of {total}")
                if not segments:
                    continue
                entries = [one.start - 1 for one in segments if one.opens]
                name = out / bridges_name(act.state)
                bridges = files.enter_context(
                    VideoWriter(VideoTarget(name, size, fps, entries=entries, synthetic=mark))
                )
                for frame in draw_in_order(animation.draw, _with_ratios(act.bridges(), ratios)):
                    bridges.write(frame)
                    done += 1
                    run.tick(done / total, f"{act.state.name}: frame {done} of {total}")


def _with_ratios(poses: Iterable[Pose], ratios: RatioStrip):  # type: ignore[no-untyped-def]
    """Each pose's motion with its ratio image, as `draw_in_order` takes them."""
    for pose in poses:
        ratio = ratios.ratio(pose.motion.frame)
        yield pose.motion, 1 + np.float32(pose.creases) * (ratio - 1)


def clip_name(state: State) -> str:
    """The file of a state's clip."""
    return f"clip-{state.name}.mp4"


def bridges_name(state: State) -> str:
    """The file of the ways out of it."""
    return f"bridges-{state.name}.mp4"


def _describe(acts: Sequence[StatePerformance], target: TargetFace, fps: float) -> Profile:
    states, transitions = {}, {}
    for act in acts:
        state = act.state
        states[state.name] = StatePart(
            title=state.title,
            emotion=state.emotion,
            clip=clip_name(state),
            frames=len(act.poses),
            loops=state.loops,
        )
        transitions[state.name] = TransitionPart(
            end=IDLE_STATE,
            bridges=bridges_name(state) if act.exits.frames else None,
            segments=[(one.start, one.length) for one in act.exits.segments()],
            at=list(act.exits.at),
        )
    triggers = [TriggerPart.model_validate(one) for one in default_triggers([act.state for act in acts])]
    return Profile(
        size=target.size, fps=fps, poster="poster.jpg", initial=IDLE_STATE,
        states=states, transitions=transitions, triggers=triggers,
    )  # fmt: skip
