"""Sheets of frames: each frame is where the document says."""

import json
from pathlib import Path

import cv2
import numpy as np
from made_clip import write_frames

from engine.avatar.capture.chosen_frames import choose_frames
from engine.avatar.frame_sheet import frame_sheet, write_frame_sheets
from engine.media.limits import Limits


def test_every_picture_has_its_place_in_rows_of_ten() -> None:
    pictures = [np.full((3, 2, 3), k + 1, np.uint8) for k in range(23)]
    sheet = frame_sheet(pictures)
    assert sheet.shape == (9, 20, 3)
    for k in range(23):
        assert (sheet[k // 10 * 3 : k // 10 * 3 + 3, k % 10 * 2 : k % 10 * 2 + 2] == k + 1).all()
    assert not sheet[6:, 6:].any()


def test_the_document_says_which_frames_they_are_and_where(tmp_path: Path) -> None:
    blocks = np.random.default_rng(3).integers(60, 256, (6, 40, 3), np.uint8).repeat(8, 0).repeat(8, 1)
    film = [np.ascontiguousarray(cv2.GaussianBlur(blocks, (0, 0), 1)[:, 2 * k : 2 * k + 64]) for k in range(30)]
    chosen = choose_frames(write_frames(tmp_path / "body.mp4", film), 12, "body", Limits())
    paths = write_frame_sheets(tmp_path, {"body": chosen}, synthetic=False)
    assert [path.name for path in paths] == ["body_frames.jpg", "frames.json"]
    told = json.loads((tmp_path / "frames.json").read_text())["body"]
    assert told["frames"] == chosen.indices.tolist()
    sheet = cv2.cvtColor(cv2.imread(str(tmp_path / told["sheet"])), cv2.COLOR_BGR2RGB)
    (width, height), columns = told["cell"], told["columns"]
    for k in range(len(chosen)):
        shown = sheet[k // columns * height :][:height, k % columns * width :][:, :width]
        assert np.abs(shown.astype(float) - chosen.picture(k)).mean() < 6
