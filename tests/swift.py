"""A real server that speaks S3: OpenStack Swift, of Debian's packages, with its S3 interface.

It keeps what it holds on the disk, looks at every signature, and outlives being killed. Of the machine it reads the
package's `/etc/swift/swift.conf` (its path is fixed); all else lies in a folder of its own. Which server the tests get,
the variable `GALATEA_TESTS_S3` says: `moto`, or `swift` (`make s3-trial`).
"""

from __future__ import annotations

import getpass
import os
import shutil
import subprocess
import tempfile
from collections.abc import Sequence
from pathlib import Path

from servers import Moto, Reach, S3Server, await_, free_port

STORES = ("account", "container", "object")
"""Swift's three kinds of stores."""

PARTITION_POWER, REPLICAS, MIN_PART_HOURS = "4", "1", "0"

COMMON = """
[DEFAULT]
bind_ip = {host}
bind_port = {port}
user = {user}
swift_dir = {folder}
devices = {folder}/devices
mount_check = false
disable_fallocate = true
workers = 0
[pipeline:main]
pipeline = {pipeline}
"""

STORE = """
[app:{kind}-server]
use = egg:swift#{kind}
# A list shows what was put before, however slow the machine is.
container_update_timeout = 60
[filter:recon]
use = egg:swift#recon
recon_cache_path = {folder}/cache
[object-updater]
interval = 1
recon_cache_path = {folder}/cache
"""

PROXY = """
[app:proxy-server]
use = egg:swift#proxy
account_autocreate = true
conn_timeout = 10
node_timeout = 60
[filter:catch_errors]
use = egg:swift#catch_errors
[filter:healthcheck]
use = egg:swift#healthcheck
[filter:cache]
use = egg:swift#memcache
memcache_servers = {host}:{cache_port}
[filter:s3api]
use = egg:swift#s3api
# Lists come in pages.
max_bucket_listing = 50
[filter:tempauth]
use = egg:swift#tempauth
user_{account}_{name} = {secret} .admin
[filter:slo]
use = egg:swift#slo
"""


class Swift(S3Server):
    """One store of each kind on one device, one copy of everything, behind a proxy; each a process of its own."""

    access_key = "tests:galatea"

    def __init__(self, host: str = "127.0.0.1", wrapper: Sequence[str] = (), reach: Reach = lambda ask: ask()):
        super().__init__(host, wrapper, reach)
        for program in ("swift-proxy-server", "memcached"):
            assert shutil.which(program), f"{program} is not installed: scripts/setup.sh --for-s3-trial"
        self.folder = Path(tempfile.mkdtemp(prefix="galatea-swift-"))
        for name in ("devices/disk", "cache"):
            (self.folder / name).mkdir(parents=True)
        self._cache_port = free_port()
        for kind in STORES:
            self._configure(kind, port := free_port(), f"recon {kind}-server", STORE)
            self._make_ring(kind, port)
        self._configure("proxy", self.port, "catch_errors healthcheck cache s3api tempauth slo proxy-server", PROXY)
        self._processes: list[subprocess.Popen[bytes]] = []
        self.start()

    def start(self) -> None:
        cache = ["memcached", "-l", self.host, "-p", str(self._cache_port), "-U", "0", "-u", getpass.getuser()]
        stores = [[f"swift-{kind}-server", self._conf(kind), "verbose"] for kind in STORES]
        late = ["swift-object-updater", self._conf("object"), "verbose"]
        self._processes += [self._run(command) for command in (cache, *stores, late)]
        proxy = self._run(["swift-proxy-server", self._conf("proxy"), "verbose"])
        self._processes.append(proxy)
        await_(lambda: "Buckets" in self._reach(lambda: self.client().list_buckets()), "Swift answers", proxy, 300)

    def stop(self) -> None:
        for process in self._processes:
            process.kill()
        for process in self._processes:
            process.wait(30)
        self._processes.clear()

    def remove(self) -> None:
        self.stop()
        shutil.rmtree(self.folder, ignore_errors=True)

    def kept(self) -> int:
        """Bytes of all objects on the disk, whether or not they are still in a list."""
        found = (self.folder / "devices" / "disk" / "objects").rglob("*.data")
        return sum(path.stat().st_size for path in found if path.exists())

    def _conf(self, kind: str) -> str:
        return str(self.folder / f"{kind}.conf")

    def _configure(self, kind: str, port: int, pipeline: str, own: str) -> None:
        account, _, name = self.access_key.partition(":")
        given = {
            "kind": kind,
            "host": self.host,
            "port": port,
            "cache_port": self._cache_port,
            "user": getpass.getuser(),
            "folder": self.folder,
        }
        given |= {"account": account, "name": name, "secret": self.secret_key, "pipeline": pipeline}
        Path(self._conf(kind)).write_text((COMMON + own).format(**given))

    def _make_ring(self, kind: str, port: int) -> None:
        """Where the things of a kind lie: on the one device."""
        builder = str(self.folder / f"{kind}.builder")
        for step in (
            ["create", PARTITION_POWER, REPLICAS, MIN_PART_HOURS],
            ["add", f"r1z1-{self.host}:{port}/disk", "1"],
            ["rebalance"],
        ):
            subprocess.run(["swift-ring-builder", builder, *step], check=True, capture_output=True)


def s3_server(host: str = "127.0.0.1", wrapper: Sequence[str] = (), reach: Reach = lambda ask: ask()) -> S3Server:
    """The server that this run of the tests is about; see `S3Server` for the arguments."""
    servers: dict[str, type[S3Server]] = {"moto": Moto, "swift": Swift}
    return servers[os.environ.get("GALATEA_TESTS_S3", "moto")](host, wrapper, reach)
