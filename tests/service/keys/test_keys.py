"""Keys: who may do what, and how much of it."""

from __future__ import annotations

import re
import time
from base64 import b64encode
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import httpx
import pytest
from galatea_command import galatea
from running import Running, eventually

from service.ids import new_id


@pytest.fixture(scope="module")
def keyed(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Running]:
    """A service that asks for keys, with one for everything (`keyed.client` sends it)."""
    data = tmp_path_factory.mktemp("keyed") / "data"
    token = galatea(
        data, "keys", "create", "root", "--scope", "admin", "--scope", "read", "--scope", "submit"
    ).stdout.strip()
    # Tests ask again and again until something is so, for as long as it takes: only limits of a key's own count here.
    rate = {"requests_per_minute": 1_000_000}
    bounds = {"uploads_at_once": 2, **rate}
    with Running(data, require_keys=True, lease_seconds=3, sweep_seconds=0.5, **bounds) as service:
        service.client.headers["Authorization"] = f"Bearer {token}"
        yield service


@pytest.fixture
def another(keyed: Running) -> Iterator[Callable[..., httpx.Client]]:
    """`another(scopes=[...])` is a client with a fresh key of these properties."""
    clients: list[httpx.Client] = []

    def make(**asked: Any) -> httpx.Client:
        made = keyed.client.post("/v1/keys", json={"name": "test", **asked}).raise_for_status().json()
        headers = {"Authorization": f"Bearer {made['token']}", "X-Key-Id": made["id"]}
        clients.append(httpx.Client(base_url=keyed.client.base_url, headers=headers, timeout=60))
        return clients[-1]

    yield make
    for client in clients:
        client.close()


def upload(client: httpx.Client, picture: bytes) -> str:
    return client.post("/v1/files", files={"file": ("p.png", picture)}).raise_for_status().json()["id"]


def submit(client: httpx.Client, file_id: str, **options: Any) -> httpx.Response:
    return client.post("/v1/jobs", json={"kind": "tiny", "inputs": {"image": file_id}, "options": options})


def code(response: httpx.Response) -> tuple[int, str]:
    return response.status_code, response.json()["code"]


def test_every_address_of_the_api_asks_for_a_key(keyed: Running) -> None:
    document = keyed.client.get("/v1/openapi.json").json()
    with httpx.Client(base_url=keyed.client.base_url) as stranger:
        for path, item in document["paths"].items():
            for method in item:
                address = re.sub(
                    r"\{\w+\}", new_id(), path
                )  # an address that no id can have needs no key to be unknown
                answer = stranger.request(method, address)
                if path in ("/healthz", "/readyz", "/v1/session") or path.startswith("/v1/public/"):
                    assert answer.status_code != 401
                else:
                    assert answer.status_code == 401, (method, path)
                    assert method == "head" or answer.json()["code"] == "key_missing", (method, path)
                    assert answer.headers["WWW-Authenticate"].startswith("Bearer")


@pytest.mark.parametrize(
    ("given", "expected"),
    [("Bearer galatea_nonsense", "key_unknown"), ("Basic dTpw", "key_malformed"), ("Bearer", "key_malformed")],
)
def test_what_is_no_key_opens_nothing(keyed: Running, given: str, expected: str) -> None:
    answer = keyed.client.get("/v1/jobs", headers={"Authorization": given})
    assert code(answer) == (401, expected)


def test_a_key_is_kept_as_a_hash_only(keyed: Running, another: Callable[..., httpx.Client]) -> None:
    token = another().headers["Authorization"].removeprefix("Bearer ")
    keyed.client.get("/v1/keys").raise_for_status()
    for path in keyed.data_dir.rglob("*"):
        assert not path.is_file() or token.encode() not in path.read_bytes(), path
    listed = keyed.client.get("/v1/keys").text
    assert token not in listed and token[:12] in listed


def test_scopes_say_what_a_key_may_do(another: Callable[..., httpx.Client], picture: bytes) -> None:
    reader, submitter = another(scopes=["read"]), another(scopes=["submit", "read"])
    assert code(reader.post("/v1/files", files={"file": ("p.png", picture)})) == (403, "scope_missing")
    assert reader.get("/v1/jobs").json()["items"] == []
    upload(submitter, picture)
    for method, address in (("GET", "/v1/keys"), ("POST", "/v1/keys"), ("GET", "/metrics"), ("DELETE", "/v1/keys/x")):
        assert code(submitter.request(method, address)) == (403, "scope_missing")


def test_what_belongs_to_another_key_is_not_there(
    keyed: Running, another: Callable[..., httpx.Client], picture: bytes, video: bytes
) -> None:
    mine, other = another(), another()
    file_id = upload(mine, picture)
    mine.post("/v1/drivers", data={"name": "grin"}, files={"file": ("d.mp4", video)}).raise_for_status()
    job = submit(mine, file_id).json()
    eventually(lambda: mine.get(f"/v1/jobs/{job['id']}").json()["status"] == "succeeded", "it succeeds")
    for address in (
        *(
            f"/v1/jobs/{job['id']}{rest}"
            for rest in ("", "/events", "/artifacts/report.json", "/archive", "/revisions")
        ),
        *(f"/v1/files/{file_id}{rest}" for rest in ("", "/content")),
        "/v1/drivers/grin/video",
    ):
        assert mine.get(address).status_code in (200, 204), address
        assert other.get(address).status_code == 404, address
    assert other.post(f"/v1/jobs/{job['id']}/cancel").status_code == 404
    assert other.post(f"/v1/jobs/{job['id']}/revisions", json={}).status_code == 404
    assert other.delete(f"/v1/jobs/{job['id']}").status_code == 404
    assert other.delete("/v1/drivers/grin").status_code == 404
    assert code(submit(other, file_id)) == (422, "unknown_file")
    assert other.get("/v1/jobs").json()["items"] == []
    assert "grin" not in {driver["name"] for driver in other.get("/v1/drivers").json()["items"]}
    other.post("/v1/drivers", data={"name": "grin"}, files={"file": ("d.mp4", video)}).raise_for_status()
    assert mine.get(f"/v1/jobs/{job['id']}").json()["status"] == "succeeded"


def test_an_idempotency_key_is_ones_own(another: Callable[..., httpx.Client], picture: bytes) -> None:
    ids = []
    for client in (another(), another()):
        job = {"kind": "tiny", "inputs": {"image": upload(client, picture)}}
        ids += [client.post("/v1/jobs", json=job, headers={"Idempotency-Key": "1"}).json()["id"] for _ in range(2)]
    assert ids[0] == ids[1] and ids[2] == ids[3] and ids[0] != ids[2]


def test_a_revoked_key_opens_nothing_and_its_jobs_stay(
    keyed: Running, another: Callable[..., httpx.Client], picture: bytes
) -> None:
    client = another()
    job = submit(client, upload(client, picture)).json()
    eventually(lambda: client.get(f"/v1/jobs/{job['id']}").json()["status"] == "succeeded", "it succeeds")
    link = client.get(f"/v1/jobs/{job['id']}").json()["artifacts"]["report.json"]["signed_url"]
    assert httpx.get(f"{client.base_url}{link}").status_code == 200
    keyed.client.delete(f"/v1/keys/{client.headers['X-Key-Id']}").raise_for_status()
    assert code(client.get("/v1/jobs")) == (401, "key_unknown")
    assert code(httpx.get(f"{client.base_url}{link}")) == (403, "link_expired")
    revoked = keyed.client.get(f"/v1/keys/{client.headers['X-Key-Id']}").json()
    assert revoked["revoked_at"] is not None


def test_a_key_that_has_expired_opens_nothing(another: Callable[..., httpx.Client]) -> None:
    client = another(expires_in_days=0.5 / 86400)
    time.sleep(0.6)
    assert code(client.get("/v1/jobs")) == (401, "key_expired")


def test_signed_links_open_one_artifact_for_a_while(another: Callable[..., httpx.Client], picture: bytes) -> None:
    client = another()
    job = submit(client, upload(client, picture)).json()
    eventually(lambda: client.get(f"/v1/jobs/{job['id']}").json()["status"] == "succeeded", "it succeeds")
    artifacts = client.get(f"/v1/jobs/{job['id']}").json()["artifacts"]
    with httpx.Client(base_url=client.base_url) as stranger:
        link = artifacts["report.json"]["signed_url"]
        report = stranger.get(link)
        assert report.json()["kind"] == "tiny"
        expires = int(httpx.URL(link).params["expires"])
        assert 3600 <= expires - time.time() <= 5400
        for changed in (
            link.replace("report.json", "preview.jpg"),
            link.replace(f"expires={expires}", f"expires={expires + 1}"),
            link[:-1] + ("A" if link[-1] != "A" else "B"),
            link.replace(f"expires={expires}", "expires=9"),
        ):
            assert code(stranger.get(changed)) == (403, "link_expired")
        assert code(stranger.get(artifacts["report.json"]["url"])) == (401, "key_missing")


def test_requests_beyond_the_rate_are_told_when_to_come_again(another: Callable[..., httpx.Client]) -> None:
    client = another(requests_per_minute=40)  # ten at once, then one each second and a half
    began, answered = time.monotonic(), 0
    while (refused := client.get("/v1/key")).status_code == 200:
        answered += 1
    assert 10 <= answered <= 10 + (time.monotonic() - began) / 1.5 + 1
    assert code(refused) == (429, "rate_limited")
    assert 1 <= int(refused.headers["Retry-After"]) <= 2
    time.sleep(int(refused.headers["Retry-After"]))
    assert client.get("/v1/key").status_code == 200


def test_jobs_under_way_are_limited(another: Callable[..., httpx.Client], picture: bytes) -> None:
    client = another(jobs_at_once=2)
    file_id = upload(client, picture)
    first, second, third = (submit(client, file_id, seconds=3000) for _ in range(3))
    assert (first.status_code, second.status_code) == (202, 202)
    assert code(third) == (429, "too_many_jobs") and int(third.headers["Retry-After"]) > 0
    assert client.get("/v1/key").json()["jobs_under_way"] == 2
    for job in (first, second):
        client.post(f"/v1/jobs/{job.json()['id']}/cancel").raise_for_status()
    assert submit(client, file_id).status_code == 202


def test_stored_bytes_are_limited(keyed: Running, another: Callable[..., httpx.Client], video: bytes) -> None:
    client = another(stored_mb=1)
    large = video + bytes(600_000)
    assert client.post("/v1/files", files={"file": ("a.mp4", large)}).status_code == 201
    kept = set((keyed.data_dir / "storage" / "files").iterdir())
    assert code(client.post("/v1/files", files={"file": ("b.mp4", large)})) == (507, "storage_quota")
    assert set((keyed.data_dir / "storage" / "files").iterdir()) == kept, "nothing of what was refused stays"
    assert client.get("/v1/key").json()["stored_bytes"] == len(large)


TUS = {"Tus-Resumable": "1.0.0"}
PIECE = TUS | {"Content-Type": "application/offset+octet-stream", "Upload-Offset": "0"}


def test_an_upload_is_its_keys_own(another: Callable[..., httpx.Client], picture: bytes) -> None:
    mine, other, reader = another(), another(), another(scopes=["read"])
    begin = TUS | {"Upload-Length": str(len(picture))}
    assert code(reader.post("/v1/uploads", headers=begin)) == (403, "scope_missing")
    address = mine.post("/v1/uploads", headers=begin).headers["location"]
    for client in (other, reader):
        assert client.get(address).status_code == 404
        assert client.head(address, headers=TUS).status_code in (403, 404)
    assert code(other.patch(address, headers=PIECE, content=picture)) == (404, "upload_not_found")
    assert code(other.delete(address, headers=TUS)) == (404, "upload_not_found")
    assert code(reader.patch(address, headers=PIECE, content=picture)) == (403, "scope_missing")
    with httpx.Client(base_url=mine.base_url) as stranger:
        answer = stranger.patch(address, headers=PIECE, content=picture)
        assert code(answer) == (401, "key_missing") and answer.headers["tus-resumable"] == "1.0.0"
    assert mine.head(address, headers=TUS).headers["upload-offset"] == "0", "nobody else has added to it"
    assert code(submit(other, address.rpartition("/")[2])) == (422, "unknown_file")
    assert mine.patch(address, headers=PIECE, content=picture).status_code == 204
    assert code(submit(other, address.rpartition("/")[2])) == (422, "unknown_file")
    assert submit(mine, address.rpartition("/")[2]).status_code == 202


def test_uploads_count_as_stored_from_their_beginning(another: Callable[..., httpx.Client], video: bytes) -> None:
    client = another(stored_mb=1)
    assert code(client.post("/v1/uploads", headers=TUS | {"Upload-Length": "1000001"})) == (507, "storage_quota")
    first = client.post("/v1/uploads", headers=TUS | {"Upload-Length": "600000"}).headers["location"]
    assert code(client.post("/v1/uploads", headers=TUS | {"Upload-Length": "600000"})) == (507, "storage_quota")
    content = video + bytes(600_000 - len(video))
    assert client.patch(first, headers=PIECE, content=content).status_code == 204
    assert client.get("/v1/key").json()["stored_bytes"] == 600_000
    endless = client.post("/v1/uploads", headers=TUS | {"Upload-Defer-Length": "1"}).headers["location"]
    assert code(client.patch(endless, headers=PIECE, content=content)) == (507, "storage_quota")
    assert client.head(endless, headers=TUS).headers["upload-offset"] == "0"
    client.delete(first, headers=TUS).raise_for_status()
    assert client.patch(endless, headers=PIECE, content=content).status_code == 204


def test_the_page_gets_a_cookie_for_a_key(keyed: Running, another: Callable[..., httpx.Client]) -> None:
    client = another()
    token = client.headers.pop("Authorization").removeprefix("Bearer ")
    assert code(client.post("/v1/session", json={"key": "galatea_wrong"})) == (401, "key_unknown")
    opened = client.post("/v1/session", json={"key": token})
    cookie = opened.headers["set-cookie"].lower()
    assert "httponly" in cookie and "samesite=strict" in cookie
    assert client.get("/v1/key").json()["id"] == client.headers["X-Key-Id"]
    foreign = client.get("/v1/key", headers={"Origin": "https://evil.example"})
    assert code(foreign) == (403, "origin_not_allowed")
    value = client.cookies["galatea_session"]
    client.cookies.clear()
    for forged in (value[:-1] + "_", "local." + value.partition(".")[2], value.replace(".", "x"), "..", "a.1.b"):
        answer = client.get("/v1/key", headers={"Cookie": f"galatea_session={forged}"})
        assert code(answer) == (401, "key_unknown")
    client.post("/v1/session", json={"key": token}).raise_for_status()
    client.delete("/v1/session").raise_for_status()
    assert "galatea_session" not in client.cookies


def test_erasing_a_key_leaves_nothing_on_disk(
    keyed: Running, another: Callable[..., httpx.Client], picture: bytes, video: bytes
) -> None:
    client, mark = another(name="Zaphod Beeblebrox"), "the-mark-of-erasure"
    marked = picture + mark.encode()
    client.post("/v1/drivers", data={"name": mark}, files={"file": ("d.mp4", video + mark.encode())})
    job = (
        client.post(
            "/v1/jobs",
            data={"kind": "tiny", "driver": mark, "metadata": f'{{"for": "{mark}"}}'},
            files={"image": (f"{mark}.png", marked)},
        )
        .raise_for_status()
        .json()
    )
    upload(client, marked)
    begin = TUS | {"Upload-Length": "100000", "Upload-Metadata": "filename " + b64encode(mark.encode()).decode()}
    client.patch(client.post("/v1/uploads", headers=begin).headers["location"], headers=PIECE, content=marked)
    eventually(lambda: client.get(f"/v1/jobs/{job['id']}").json()["status"] == "succeeded", "it succeeds")
    client.post(f"/v1/jobs/{job['id']}/revisions", json={"options": {"seconds": 3000}}).raise_for_status()
    owner = client.headers["X-Key-Id"]
    assert mark.encode() in b"".join(path.read_bytes() for path in keyed.data_dir.rglob("*") if path.is_file())
    keyed.client.delete(f"/v1/keys/{owner}", params={"erase": True}).raise_for_status()

    def holds_it(path: Path) -> bool:
        try:
            return path.is_file() and mark.encode() in path.read_bytes()
        except FileNotFoundError:  # erased since it was listed
            return False

    def left() -> list[Path]:
        named = [path for path in keyed.data_dir.rglob("*") if job["id"] in path.name or mark in path.name]
        return named + [path for path in keyed.data_dir.rglob("*") if holds_it(path)]

    eventually(lambda: left() == [], "nothing is left")  # the log of SQLite is emptied now and then


def test_the_shell_makes_lists_and_revokes_keys(tmp_path: Path) -> None:
    made = galatea(tmp_path, "keys", "create", "shop", "--scope", "read", "--jobs-at-once", "3")
    assert re.fullmatch(r"galatea_[\w-]{43}\n", made.stdout)
    key_id = re.search(r"Key (\S+)", made.stderr)[1]  # type: ignore[index]
    assert galatea(tmp_path, "keys", "create", "shop", "--if-none").stdout == ""
    listed = galatea(tmp_path, "keys", "list").stdout
    assert "shop" in listed and made.stdout[:12] in listed and made.stdout.strip() not in listed
    assert galatea(tmp_path, "keys", "revoke", key_id).exit_code == 0
    assert "revoked" in galatea(tmp_path, "keys", "list").stdout
    assert galatea(tmp_path, "keys", "create", "shop", "--if-none").stdout != ""
    for wrong in (("revoke", "nobody"), ("create", "x", "--scope", "rule"), ("revoke", "local")):
        ended = galatea(tmp_path, "keys", *wrong)
        assert ended.exit_code == 2 and len(ended.stderr.splitlines()) == 1


def test_where_no_key_is_needed_one_still_counts(running: Running, picture: bytes) -> None:
    key = running.client.post("/v1/keys", json={"name": "mine"}).raise_for_status().json()
    file_id = upload(running.client, picture)
    headers = {"Authorization": f"Bearer {key['token']}"}
    assert running.client.get(f"/v1/files/{file_id}", headers=headers).status_code == 404
    assert running.client.get("/v1/jobs", headers={"Authorization": "Bearer x"}).status_code == 401
    assert running.client.get("/v1/key").json()["id"] == "local"
    running.client.delete(f"/v1/keys/{key['id']}").raise_for_status()


def test_ended_jobs_are_erased_after_the_days_that_the_operator_set(
    start: Callable[..., Running], picture: bytes
) -> None:
    service = start(job_days=1 / 86400, sweep_seconds=0.1)
    job = service.submit(picture)
    eventually(lambda: service.client.get(f"/v1/jobs/{job['id']}").status_code == 404, "it is erased")
    eventually(lambda: list((service.data_dir / "storage").glob("*/*")) == [], "its media too")


def test_only_a_key_of_an_administrator_lets_jobs_come_first(
    keyed: Running, another: Callable[..., httpx.Client], picture: bytes
) -> None:
    plain = another(scopes=["read", "submit"])
    asked = {"kind": "tiny", "inputs": {"image": upload(plain, picture)}}
    urgent = asked | {"priority": "high"}
    assert code(plain.post("/v1/jobs", json=urgent)) == (403, "priority_not_allowed")
    form = {"kind": "tiny", "priority": "high"}
    refused = plain.post("/v1/jobs", data=form, files={"image": ("p.png", picture)})
    assert code(refused) == (403, "priority_not_allowed")
    made = plain.post("/v1/jobs", json=asked | {"priority": "low"})
    keyed_job = made.raise_for_status().json()["id"]
    eventually(lambda: plain.get(f"/v1/jobs/{keyed_job}").json()["status"] == "succeeded", "it has ended")
    again = plain.post(f"/v1/jobs/{keyed_job}/revisions", json={"priority": "high"})
    assert code(again) == (403, "priority_not_allowed")
    urgent["inputs"] = {"image": upload(keyed.client, picture)}
    assert keyed.client.post("/v1/jobs", json=urgent).raise_for_status().json()["priority"] == "high"


def test_a_key_has_so_many_uploads_at_once(another: Callable[..., httpx.Client], picture: bytes) -> None:
    client = another()

    def begin() -> httpx.Response:
        return client.post("/v1/uploads", headers=TUS | {"Upload-Length": str(len(picture))})

    first, second = begin().raise_for_status(), begin().raise_for_status()
    third = begin()
    assert code(third) == (429, "too_many_uploads") and int(third.headers["Retry-After"]) > 0
    client.patch(first.headers["Location"], content=picture, headers=PIECE).raise_for_status()
    begin().raise_for_status()  # the first is finished, so there is a place
    assert code(begin()) == (429, "too_many_uploads")
    client.delete(second.headers["Location"], headers=TUS).raise_for_status()
    begin().raise_for_status()


def linked(client: httpx.Client, keyed: Running, picture: bytes) -> dict[str, Any]:
    """A public link to a job of this client's."""
    job = submit(client, upload(client, picture)).json()["id"]
    return client.post(f"/v1/jobs/{job}/links", json={"expires_in_hours": None}).raise_for_status().json()


def test_public_links_end_with_their_key(keyed: Running, another: Callable[..., httpx.Client], picture: bytes) -> None:
    shop, other = another(), another()
    links = [linked(shop, keyed, picture), linked(other, keyed, picture)]
    with httpx.Client(base_url=keyed.client.base_url) as stranger:
        assert [stranger.get(link["url"]).status_code for link in links] == [200, 200]
        keyed.client.delete(f"/v1/keys/{shop.headers['X-Key-Id']}").raise_for_status()
        assert [stranger.get(link["url"]).status_code for link in links] == [404, 200]
    assert links[0]["id"] not in [one["id"] for one in keyed.client.get("/v1/links").json()["items"]]


def test_who_manages_keys_sees_and_revokes_all_links(
    keyed: Running, another: Callable[..., httpx.Client], picture: bytes
) -> None:
    shop, other, manager = another(), another(), another(scopes=["admin"])
    mine, theirs = linked(shop, keyed, picture), linked(other, keyed, picture)

    def seen(client: httpx.Client) -> set[str]:
        return {one["id"] for one in client.get("/v1/links").raise_for_status().json()["items"]}

    assert seen(shop) == {mine["id"]}
    assert {mine["id"], theirs["id"]} <= seen(manager)
    assert code(shop.delete(f"/v1/links/{theirs['id']}")) == (404, "link_not_found")
    assert manager.delete(f"/v1/links/{theirs['id']}").status_code == 204
    assert keyed.client.get(theirs["url"]).status_code == 404
    assert code(another(scopes=["submit"]).get("/v1/links")) == (403, "scope_missing")

    assert mine["hint"] in galatea(keyed.data_dir, "keys", "links").stdout
    assert galatea(keyed.data_dir, "keys", "revoke-link").exit_code == 2
    assert galatea(keyed.data_dir, "keys", "revoke-link", new_id()).exit_code == 2
    assert galatea(keyed.data_dir, "keys", "revoke-link", mine["id"]).exit_code == 0
    assert seen(shop) == set()


def test_wrong_keys_are_slowed_down_and_good_ones_are_not(start: Callable[..., Running], tmp_path: Path) -> None:
    token = galatea(tmp_path / "data", "keys", "create", "root").stdout.strip()
    running = start(worker="false", require_keys=True, wrong_keys_per_minute=1, trusted_proxies="127.0.0.0/8")

    def ask(key: str, address: str) -> httpx.Response:
        return running.client.get("/v1/jobs", headers={"Authorization": f"Bearer {key}", "X-Forwarded-For": address})

    assert code(ask("galatea_wrong", "203.0.113.7")) == (401, "key_unknown")
    refused = ask("galatea_another", "203.0.113.7")
    assert code(refused) == (429, "too_many_wrong_keys") and 1 <= int(refused.headers["Retry-After"]) <= 60
    assert ask("galatea_another", "198.51.100.1, 203.0.113.7").status_code == 429, "what comes first anybody may write"
    session = running.client.post("/v1/session", json={"key": "x"}, headers={"X-Forwarded-For": "203.0.113.7"})
    assert code(session) == (429, "too_many_wrong_keys")
    assert ask(token, "203.0.113.7").status_code == 200, "a good key from the same address"
    assert ask("galatea_wrong", "203.0.113.8").status_code == 401, "another address"
    assert ask("galatea_wrong", "2001:db8:1:2::1").status_code == 401
    assert ask("galatea_wrong", "2001:db8:1:2:3::4").status_code == 429, "one network of 64 bits is one place"
    assert running.client.get("/v1/jobs").json()["code"] == "key_missing", "who brings no key is told so"

    answers = [ask("galatea_wrong", f"192.0.{one}.1") for one in range(60)]
    assert [one.status_code for one in answers[:10]] == [401] * 10
    assert 429 in [one.status_code for one in answers], "those of everybody together are bounded"
