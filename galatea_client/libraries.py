"""What a service offers to work with: its kinds, and the drivers and motions that it has and that are kept there."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from galatea_client.models import Driver, Kind, Live, Motion
from galatea_client.requests import J, Requests
from galatea_client.transfer import OnProgress, Upload, send_file, target_file
from galatea_client.works import Source


class Libraries(Requests[J]):
    """The methods for kinds, drivers and motions."""

    # Kinds and drivers

    async def kinds(self) -> list[Kind]:
        """The job kinds, with the JSON schemas of their inputs and options."""
        return [self._read(Kind, one) for one in (await self._call("list_kinds"))["items"]]

    async def drivers(self) -> list[Driver]:
        """The built-in performances, then one's own driving videos."""
        return [self._read(Driver, one) for one in (await self._call("list_drivers"))["items"]]

    async def driver(self, name: str) -> Driver:
        """A driver; once its `moments_status` is `ready`, with the moments that hold emotions."""
        return self._read(Driver, await self._call("get_driver", name=name))

    async def search_driver(self, name: str) -> Driver:
        """Search one of one's own drivers for moments again."""
        return self._read(Driver, await self._call("search_driver", name=name))

    async def create_driver(self, name: str, source: Upload, progress: OnProgress | None = None) -> Driver:
        """Keep a driving video under a name. It is searched for moments then: see `driver`."""
        answer = await send_file(self._transport, "create_driver", source, progress, {"name": name})
        return self._read(Driver, answer.json())

    async def rename_driver(self, name: str, new: str) -> Driver:
        """Give one of one's own drivers another name. Raises `Conflict` where there is one of that name."""
        return self._read(Driver, await self._call("rename_driver", json={"name": new}, name=name))

    async def delete_driver(self, name: str) -> None:
        """Erase one of one's own drivers."""
        await self._transport.call("delete_driver", path={"name": name})

    # Motions

    async def motions(self) -> list[Motion]:
        """The built-in motions, then one's own."""
        return [self._read(Motion, one) for one in (await self._call("list_motions"))["items"]]

    async def motion(self, name: str) -> Motion:
        """A motion; once its `check_status` is `ready`, with its skeleton and which of its joints moves which."""
        return self._read(Motion, await self._call("get_motion", name=name))

    async def create_motion(self, name: str, source: Source, progress: OnProgress | None = None) -> Motion:
        """Keep a BVH or GLB file under a name: a `Path`, or the id of an uploaded file. It is checked then: see
        `motion`."""
        if not isinstance(source, str):
            answer = await send_file(self._transport, "create_motion", source, progress, {"name": name})
            return self._read(Motion, answer.json())
        return self._read(Motion, await self._call("create_motion", json={"name": name, "file": source}))

    async def check_motion(self, name: str) -> Motion:
        """Check one of one's own motions again."""
        return self._read(Motion, await self._call("check_motion", name=name))

    async def rename_motion(self, name: str, new: str) -> Motion:
        """Give one of one's own motions another name. Raises `Conflict` where there is one of that name."""
        return self._read(Motion, await self._call("rename_motion", json={"name": new}, name=name))

    async def delete_motion(self, name: str) -> None:
        """Erase one of one's own motions."""
        await self._transport.call("delete_motion", path={"name": name})

    async def download_motion(self, motion: Motion, to: str | Path = ".") -> Path:
        """Fetch the file of one of one's own motions to a file."""
        target = target_file(to, motion.name)
        answer = await self._transport.call("get_motion_file", path={"name": motion.name})
        await self._transport.line.aside(target.write_bytes, answer.content)
        return target

    async def create_live(
        self, image: str | None = None, job: str | None = None, options: Mapping[str, Any] | None = None
    ) -> Live:
        """Begin a live portrait of an uploaded picture, or of a portrait job's (ids). Its frames go by a WebSocket (docs/live.md)."""
        wanted = {"image": image, "job": job, "options": dict(options or {})}
        return self._read(Live, await self._call("create_live", json=wanted))

    async def live(self, live_id: str) -> Live:
        """How a live portrait is."""
        return self._read(Live, await self._call("get_live", live_id=live_id))

    async def end_live(self, live_id: str) -> None:
        """End a live portrait."""
        await self._transport.call("end_live", path={"live_id": live_id})
