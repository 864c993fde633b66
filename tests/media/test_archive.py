"""Archives of photographs: what is in them comes out under our names; what would do harm is refused."""

from __future__ import annotations

import io
import os
import tarfile
import zipfile
from collections.abc import Callable
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine.errors import InputError
from engine.media import archive
from engine.media.archive import is_archive, unpack_pictures

PHOTO = b"\xff\xd8\xff" + os.urandom(3000)


def zipped(path: Path, members: dict[str, bytes]) -> Path:
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as out:
        for name, data in members.items():
            out.writestr(name, data)
    return path


def tarred(path: Path, members: dict[str, bytes], mode: str = "w:gz") -> Path:
    with tarfile.open(path, mode) as out:  # type: ignore[call-overload]
        for name, data in members.items():
            info = tarfile.TarInfo(name)
            info.size = len(data)
            out.addfile(info, io.BytesIO(data))
    return path


def refused(path: Path, tmp_path: Path) -> str:
    folder = tmp_path / "out"
    folder.mkdir(exist_ok=True)
    with pytest.raises(InputError) as error:
        unpack_pictures(path, folder)
    assert {one.resolve().parent for one in folder.rglob("*")} <= {folder.resolve()}
    return error.value.code


@pytest.mark.parametrize("pack", [zipped, tarred, lambda path, members: tarred(path, members, "w:xz")])
def test_pictures_come_out_as_they_were(tmp_path: Path, pack: Callable[[Path, dict[str, bytes]], Path]) -> None:
    members = {
        "holiday/one.jpg": PHOTO,
        "holiday/deeper/zwei ü.jpg": PHOTO[::-1],
        "__MACOSX/holiday/._one.jpg": b"x",
        "holiday/.DS_Store": b"y",
        "Thumbs.db": b"z",
    }
    path = pack(tmp_path / "photos", members)
    (tmp_path / "out").mkdir()
    files = unpack_pictures(path, tmp_path / "out")
    assert is_archive(path)
    assert [(one.name, one.path.read_bytes()) for one in files] == [("one.jpg", PHOTO), ("zwei ü.jpg", PHOTO[::-1])]
    assert all(one.path.parent == tmp_path / "out" and one.path.name.isdigit() for one in files)


def test_a_picture_is_no_archive(tmp_path: Path) -> None:
    (tmp_path / "one.jpg").write_bytes(PHOTO)
    assert not is_archive(tmp_path / "one.jpg")


@pytest.mark.parametrize("name", ["../one.jpg", "a/../../one.jpg", "/etc/one.jpg", "C:\\one.jpg", "..\\one.jpg"])
@pytest.mark.parametrize("pack", [zipped, tarred])
def test_names_that_lead_outside_are_refused(
    tmp_path: Path, name: str, pack: Callable[[Path, dict[str, bytes]], Path]
) -> None:
    assert refused(pack(tmp_path / "photos", {"good.jpg": PHOTO, name: PHOTO}), tmp_path) == "archive_unsafe"


@pytest.mark.parametrize("kind", [tarfile.SYMTYPE, tarfile.LNKTYPE, tarfile.FIFOTYPE, tarfile.CHRTYPE])
def test_links_and_devices_in_a_tar_are_refused(tmp_path: Path, kind: bytes) -> None:
    info = tarfile.TarInfo("link.jpg")
    info.type, info.linkname = kind, "/etc/passwd"
    with tarfile.open(tmp_path / "photos.tar", "w") as out:
        out.addfile(info)
    assert refused(tmp_path / "photos.tar", tmp_path) == "archive_unsafe"


def test_links_in_a_zip_are_refused(tmp_path: Path) -> None:
    info = zipfile.ZipInfo("link.jpg")
    info.external_attr = 0o120777 << 16
    with zipfile.ZipFile(tmp_path / "photos.zip", "w") as out:
        out.writestr(info, "/etc/passwd")
    assert refused(tmp_path / "photos.zip", tmp_path) == "archive_unsafe"


@pytest.mark.parametrize("pack", [zipped, tarred, lambda path, members: tarred(path, members, "w")])
def test_an_archive_in_an_archive_is_refused(tmp_path: Path, pack: Callable[[Path, dict[str, bytes]], Path]) -> None:
    inner = pack(tmp_path / "inner", {"one.jpg": PHOTO}).read_bytes()
    assert refused(zipped(tmp_path / "outer.zip", {"more.jpg": inner}), tmp_path) == "archive_nested"


def test_absurd_expansion_is_refused_before_it_is_written(tmp_path: Path) -> None:
    path = zipped(tmp_path / "bomb.zip", {f"{k}.jpg": bytes(30_000_000) for k in range(3)})
    assert refused(path, tmp_path) == "archive_too_large"
    written = sum(one.stat().st_size for one in (tmp_path / "out").iterdir())
    assert written <= archive.FREE_BYTES + archive.MAX_EXPANSION * path.stat().st_size


def test_lies_about_sizes_are_not_believed(tmp_path: Path) -> None:
    path = zipped(tmp_path / "liar.zip", {"one.jpg": bytes(30_000_000)})
    data = bytearray(path.read_bytes())
    at = data.index((30_000_000).to_bytes(4, "little"))
    while at >= 0:
        data[at : at + 4] = (3000).to_bytes(4, "little")
        at = data.find((30_000_000).to_bytes(4, "little"))
    path.write_bytes(data)
    assert refused(path, tmp_path) in ("archive_unreadable", "archive_too_large")
    assert sum(one.stat().st_size for one in (tmp_path / "out").iterdir()) < 15_000_000


def test_too_many_files_are_refused(tmp_path: Path) -> None:
    path = zipped(tmp_path / "many.zip", {f"{k}.jpg": b"x" for k in range(archive.MAX_FILES + 1)})
    assert refused(path, tmp_path) == "archive_too_large"


def test_a_password_is_told(tmp_path: Path) -> None:
    path = zipped(tmp_path / "locked.zip", {"one.jpg": PHOTO})
    data = bytearray(path.read_bytes())
    for magic, flags in ((b"PK\x03\x04", 6), (b"PK\x01\x02", 8)):
        data[data.index(magic) + flags] |= 1
    path.write_bytes(data)
    assert refused(path, tmp_path) == "archive_encrypted"


@given(st.integers(0, 5000), st.binary(min_size=1, max_size=40))
def test_broken_ones_end_in_an_error_with_a_code(
    tmp_path_factory: pytest.TempPathFactory, at: int, noise: bytes
) -> None:
    folder = tmp_path_factory.mktemp("broken")
    for pack in (zipped, tarred):
        path = pack(folder / "photos", {"one.jpg": PHOTO, "two.jpg": PHOTO})
        data = bytearray(path.read_bytes())
        place = at % len(data)
        data[place : place + len(noise)] = noise
        path.write_bytes(data[: -(at % 7) or None])
        out = folder / pack.__name__
        out.mkdir()
        try:
            unpack_pictures(path, out)
        except InputError as error:
            assert error.code.startswith("archive_")
