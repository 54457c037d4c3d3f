"""What a page in another tab, another user of the machine, a hostile file or a kill can do."""

from __future__ import annotations

import http.client
import os
import re
import socket
import stat
import subprocess
import threading
import time
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from urllib.parse import urlsplit

import pytest
from conftest import EXAMPLES, Lab, opened, started
from playwright.sync_api import Browser
from records import HOSTILE, steps, write


def answer(lab: Lab, path: str, method: str = "GET", body: bytes = b"", **headers: str) -> tuple[int, str]:
    """The answer to a request of any program of the machine; `path` is sent as it stands."""
    port = urlsplit(lab.address).port
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=20)
    named = {name.replace("_", "-"): value for name, value in headers.items()}
    connection.request(method, path, body, {"host": f"127.0.0.1:{port}", **named})
    found = connection.getresponse()
    text = found.read().decode(errors="replace")
    connection.close()
    return found.status, text


def test_another_user_gets_nothing_without_the_address(lab: Lab) -> None:
    token = urlsplit(lab.address).path.strip("/")
    assert re.fullmatch("[0-9a-f]{32}", token)
    for path in ["/", "/api/folder", f"/{'0' * 32}/", f"/{token[:31]}/", f"/{token[:-1]}x/api/folder", f"//{token[1:]}/"]:
        status, text = answer(lab, path)
        assert status == 404 and token not in text and "ball" not in text, path
    # The address is in no argument of a process, where every user reads it.
    words = Path(f"/proc/{lab.process.pid}/cmdline")
    if words.exists():
        assert token.encode() not in words.read_bytes()
    # Only the loopback interface listens.
    port = urlsplit(lab.address).port
    own = socket.gethostbyname(socket.gethostname())
    if not own.startswith("127."):
        with pytest.raises(OSError):
            socket.create_connection((own, port), timeout=1).close()


def test_the_browser_gets_the_address_by_a_file_that_is_private(tmp_path: Path) -> None:
    opened_with = tmp_path / "arguments"
    opener = tmp_path / "bin/xdg-open"
    opener.parent.mkdir()
    opener.write_text(f"#!/bin/sh\nprintf '%s\\n' \"$@\" > '{opened_with}.part' && mv '{opened_with}.part' '{opened_with}'\n")
    opener.chmod(0o755)
    where = {**os.environ, "PATH": f"{opener.parent}:{os.environ['PATH']}", "TMPDIR": str(tmp_path)}
    words = [os.environ["PALPATE"], "lab", str(tmp_path)]
    with subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=where) as lab:
        assert lab.stdout is not None
        address = lab.stdout.readline().strip()
        end = time.monotonic() + 10
        while not opened_with.exists() and time.monotonic() < end:
            time.sleep(0.05)
        [argument] = opened_with.read_text().splitlines()
        page = Path(argument)
        assert urlsplit(address).path.strip("/") not in argument
        assert address in page.read_text()
        assert stat.S_IMODE(page.parent.stat().st_mode) == 0o700
        lab.terminate()
    assert not page.exists()


def test_a_temporary_folder_is_private_and_goes(tmp_path: Path) -> None:
    os.environ["TMPDIR"] = str(tmp_path)
    try:
        lab = started(None)
    finally:
        del os.environ["TMPDIR"]
    [folder] = list(tmp_path.iterdir())
    assert stat.S_IMODE(folder.stat().st_mode) == 0o700
    lab.end()
    assert list(tmp_path.iterdir()) == []


def test_no_path_leaves_the_folder(lab: Lab, tmp_path: Path) -> None:
    assert lab.folder is not None
    (tmp_path / "secret.csv").write_text("secret")
    base = urlsplit(lab.address).path
    (lab.folder / "link.csv").symlink_to(tmp_path / "secret.csv")
    (lab.folder / "link.csv.test.toml").symlink_to(tmp_path / "secret.toml")
    for name in ["../secret.csv", "..%2fsecret.csv", "%2e%2e/secret.csv", "%2fetc%2fpasswd", "..%5csecret.csv", "link.csv"]:
        for path in [f"api/materials/{name}", f"api/tasks/1/files/{name}", f"assets/{name}"]:
            status, text = answer(lab, base + path)
            assert status in {400, 404, 422} and "secret" not in text.replace(name, "").replace("secret.csv", ""), (path, text)
        for body in [f'{{"file": "{name}"}}', f'{{"file": "{name}", "part": "../x"}}']:
            status, text = answer(lab, base + "api/described", "POST", body.encode(), content_type="application/json")
            assert '"text":"secret"' not in text
        edit = f'{{"subject": {{"file": "{name}"}}, "edits": [{{"key": ["about", "title"], "value": "x"}}]}}'
        status, text = answer(lab, base + "api/edit", "POST", edit.encode(), content_type="application/json")
        assert status in {404, 422}, text
    for name in ["..%2fout.csv", "%2ftmp%2fout.csv", "a%2f..%2f..%2fout.csv", "..%5cout.csv", ".bashrc", "%00.csv"]:
        status, text = answer(lab, base + f"api/files/{name}", "PUT", b"1")
        assert status in {200, 400, 404, 422, 500}
    assert not (tmp_path / "out.csv").exists() and not (tmp_path / "secret.toml").exists()
    assert (tmp_path / "secret.csv").read_text() == "secret"
    assert all(entry.parent == lab.folder for entry in lab.folder.iterdir())
    assert not any(entry.name.startswith(".bash") for entry in lab.folder.iterdir())


class Elsewhere(BaseHTTPRequestHandler):
    """A site of somebody else."""

    def do_GET(self) -> None:
        self.send_response(200)
        self.send_header("content-type", "text/html")
        self.end_headers()
        self.wfile.write(b"<!DOCTYPE html><title>elsewhere</title>")

    def log_message(self, *_: object) -> None:
        pass


def test_a_page_in_another_tab_reaches_nothing(browser: Browser, lab: Lab) -> None:
    """Even with the address, which it cannot know."""
    assert lab.folder is not None
    (lab.folder / "ball.csv").write_bytes((EXAMPLES / "ball.csv").read_bytes())
    site = ThreadingHTTPServer(("127.0.0.1", 0), Elsewhere)
    threading.Thread(target=site.serve_forever, daemon=True).start()
    page = browser.new_context().new_page()
    page.goto(f"http://127.0.0.1:{site.server_address[1]}/")
    tried = page.evaluate(
        """async (address) => {
            const found = {};
            const attempt = async (name, work) => { try { found[name] = await work(); } catch (error) { found[name] = "refused"; } };
            await attempt("read", async () => (await fetch(address + "api/folder")).status);
            await attempt("blind", async () => (await fetch(address + "api/files/evil.csv", { method: "PUT", mode: "no-cors", body: "1" })).type);
            await attempt("post", async () => (await fetch(address + "api/tasks", { method: "POST", mode: "no-cors", headers: { "content-type": "text/plain" }, body: "{}" })).type);
            await attempt("script", () => new Promise((resolve, reject) => {
                const script = Object.assign(document.createElement("script"), { src: address + "assets/lab.js", onload: () => resolve("ran"), onerror: reject });
                document.body.append(script);
            }));
            await attempt("frame", () => new Promise((resolve) => {
                const frame = Object.assign(document.createElement("iframe"), { src: address, onload: () => { try { resolve(frame.contentDocument.title); } catch { resolve("closed"); } } });
                document.body.append(frame);
            }));
            await attempt("form", () => new Promise((resolve) => {
                const frame = Object.assign(document.createElement("iframe"), { name: "target" });
                const form = Object.assign(document.createElement("form"), { action: address + "api/edit", method: "post", enctype: "text/plain", target: "target" });
                form.append(Object.assign(document.createElement("input"), { name: '{"subject":{"file":"ball.csv"},"edits":[{"key":["about","title"],"value":"', value: 'evil"}]}' }));
                document.body.append(frame, form);
                frame.onload = () => { try { resolve(frame.contentDocument.body.textContent); } catch { resolve("closed"); } };
                form.submit();
            }));
            await attempt("socket", () => new Promise((resolve, reject) => {
                const socket = new WebSocket(address.replace("http", "ws") + "api/changes?revision=0");
                socket.onopen = () => resolve("open");
                socket.onerror = reject;
            }));
            await attempt("events", () => new Promise((resolve, reject) => {
                const events = new EventSource(address + "api/changes?revision=0");
                events.onmessage = () => resolve("heard");
                events.onerror = reject;
            }));
            await attempt("window", async () => {
                const opened = window.open(address);
                await new Promise((resolve) => setTimeout(resolve, 500));
                try { return opened?.document?.title ?? "severed"; } catch { return "severed"; }
            });
            return found;
        }""",
        lab.address,
    )
    assert tried["read"] == "refused" and tried["script"] == "refused" and tried["post"] in {"opaque", "refused"}, tried
    assert tried["frame"] in {"closed", "", None} and tried["window"] == "severed", tried
    assert tried["form"] == "closed" and tried["socket"] == "refused" and tried["events"] == "refused", tried
    assert [entry.name for entry in lab.folder.iterdir()] == ["ball.csv"]
    # The name of another site that leads to this machine (DNS rebinding), and foreign origins.
    base = urlsplit(lab.address).path
    assert answer(lab, base + "api/folder", host="evil.example")[0] == 403
    assert answer(lab, base + "api/folder", origin="http://evil.example")[0] == 403
    assert answer(lab, base + "api/files/x.csv", "PUT", b"1", origin="null")[0] == 403
    assert answer(lab, base + "api/folder", sec_fetch_site="cross-site")[0] == 403
    page.context.close()
    site.shutdown()


def test_a_hostile_file_stays_text(browser: Browser, lab: Lab, tmp_path: Path) -> None:
    assert lab.folder is not None
    table = steps([3.0, 1.0], 12.0, 12.0, 3)
    lines = [f'"{HOSTILE.replace(chr(34), chr(34) * 2)} Time (s)",Displacement (mm),"Force <b onmouseover=alert(3)> (N)"']
    lines += [",".join(f"{value:.5f}" for value in row) for row in table]
    hostile = tmp_path / "a <img src=x onerror=alert(4)> & 'b'.csv"
    hostile.write_text("\n".join(lines))
    found = opened(browser, lab.address)
    page = found.page
    found.drop(hostile)
    found.wait("#record figure, #record .finding")
    found.settle()
    page.click("#text > summary")
    title = HOSTILE.replace("\\", "\\\\")
    page.fill("#text textarea", f"[about]\ntitle = '''{title}'''\n[columns]\ntime = {{ column = 1 }}\nforce = {{ column = 3 }}\n")
    page.get_by_role("button", name="Apply").click()
    found.settle()
    page.click("#columns > summary")
    assert page.locator("img").count() == 0 and page.evaluate("window.owned ?? null") is None
    if page.locator("#report > summary").count():
        page.click("#report > summary")
        page.frame_locator("#report iframe").locator("h1").wait_for()
        assert page.frame_locator("#report iframe").locator("img").count() == 0
    # The policy holds for whatever gets in all the same.
    kinds = page.evaluate("""async () => {
        const kinds = [];
        document.addEventListener("securitypolicyviolation", (event) => kinds.push(event.effectiveDirective));
        const add = (name, values) => document.body.append(Object.assign(document.createElement(name), values));
        add("script", { textContent: "window.owned = 1" });
        add("img", { src: "http://127.0.0.1:9/x.png" });
        add("iframe", { src: "http://127.0.0.1:9/" });
        await fetch("http://127.0.0.1:9/").catch(() => 0);
        await new Promise((resolve) => setTimeout(resolve, 300));
        return [kinds.sort(), window.owned ?? null];
    }""")
    assert kinds[1] is None and set(kinds[0]) == {"connect-src", "frame-src", "img-src", "script-src-elem"}
    assert not [message for message in found.messages if message.startswith("dialog")]
    found.context.close()


def test_files_that_are_none_and_files_that_are_too_much(lab: Lab) -> None:
    assert lab.folder is not None
    base = urlsplit(lab.address).path
    status, text = answer(lab, base + "api/tasks", "POST", b"{" * 100, content_type="application/json")
    assert status in {400, 422}
    status, text = answer(lab, base + "api/state", "POST", b"x" * (3 << 20), content_type="application/json")
    assert status == 413
    for request in ['{"request": {"kind": "inspect", "subject": {"file": "none.csv"}}}']:
        status, text = answer(lab, base + "api/tasks", "POST", request.encode(), content_type="application/json")
        assert status == 200
    # An upload that ends in the middle leaves nothing.
    port = urlsplit(lab.address).port
    with socket.create_connection(("127.0.0.1", port)) as half:
        head = f"PUT {base}api/files/half.csv HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nContent-Length: 1000000\r\n\r\n"
        half.sendall(head.encode() + b"1,2\n" * 1000)
        time.sleep(0.3)
    time.sleep(0.5)
    assert [entry for entry in lab.folder.iterdir() if not entry.name.startswith(".palpate-")] == []


def test_two_tabs_show_one_state_and_a_kill_is_stated(browser: Browser, tmp_path: Path) -> None:
    folder = tmp_path / "records"
    folder.mkdir()
    (folder / "ball.csv").write_bytes((EXAMPLES / "ball.csv").read_bytes())
    lab = started(folder)
    one, other = opened(browser, lab.address), opened(browser, lab.address)
    for tab in (one, other):
        tab.wait("#laws .lede")
        tab.settle()
    one.page.get_by_role("button", name="Remove hold 5").click()
    other.wait("caption:has-text('Holds as stated')")
    other.settle()
    assert other.page.locator("#holds tbody tr").count() == 4
    # Killed in the middle of a work and of an upload: nothing half is left, and the page says so.
    port = urlsplit(lab.address).port
    base = urlsplit(lab.address).path
    half = socket.create_connection(("127.0.0.1", port))
    head = f"PUT {base}api/files/half.csv HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nContent-Length: 1000000\r\n\r\n"
    half.sendall(head.encode() + b"1,2\n" * 1000)
    time.sleep(0.3)
    one.page.get_by_role("button", name="Remove hold 4").click()
    lab.kill()
    half.close()
    one.wait("#lost:visible")
    assert "Start it again" in one.page.inner_text("#lost")
    left = sorted(entry.name for entry in folder.iterdir() if not entry.name.startswith("."))
    assert left == ["ball.csv", "ball.csv.test.toml"]
    # What lies in the folder is the state: the next lab goes on with it, and removes what the kill left. At the same port it has another
    # address, and the page still says so.
    lab = started(folder, "--port", str(port))
    assert lab.address.startswith(f"http://127.0.0.1:{port}/") and urlsplit(lab.address).path != base
    one.page.wait_for_timeout(4500)
    shown = one.page.evaluate("""async () => {
        const box = document.querySelector("#lost");
        let changes = 0;
        new MutationObserver(() => (changes += 1)).observe(box, { attributes: true, childList: true, characterData: true, subtree: true });
        await new Promise((resolve) => setTimeout(resolve, 4500));
        return [box.hidden, box.textContent, changes];
    }""")
    assert shown[0] is False and "open the address that it prints" in shown[1] and shown[2] == 0, shown
    one.page.get_by_role("button", name="Remove hold 1").click()
    again = opened(browser, lab.address)
    again.wait("caption:has-text('Holds as stated')")
    # The last correction before the kill is whole or was not made; the one after it, by the old address, was not.
    assert again.page.locator("#holds tbody tr").count() in {3, 4}
    assert again.page.get_by_label("Start of hold 1, in seconds").input_value() == one.page.get_by_label("Start of hold 1, in seconds").input_value()
    again.drop(write(tmp_path / "next.csv", steps([3.0], 8.0, 12.0, 5)))
    again.wait("h2:has-text('next.csv')")
    again.settle()
    assert not [entry.name for entry in folder.iterdir() if entry.name.startswith(".palpate-")]
    for tab in (one, other, again):
        tab.context.close()
    lab.end()


FULL = "ERROR {}: cannot write: no storage space\n\nWhat helps: free some space; nothing was written"


def test_a_full_disk_is_stated_and_leaves_nothing_half(browser: Browser, tmp_path: Path) -> None:
    """The folder on a file system of 2 MB of its own, which other processes do not see."""
    folder = tmp_path / "small"
    folder.mkdir()
    mount = ["unshare", "--user", "--map-root-user", "--mount", "sh", "-c", 'mount -t tmpfs -o size=2m none "$0" && exec "$@"', str(folder)]
    allowed = subprocess.run([*mount, "true"], capture_output=True)
    if allowed.returncode and os.environ.get("CI") != "true":
        pytest.skip(f"no file system of its own: {allowed.stderr.decode().strip()}")
    lab = started(folder, under=mount)
    inside = Path(f"/proc/{lab.process.pid}/root{folder}")
    names = lambda: sorted(entry.name for entry in inside.iterdir())
    found = opened(browser, lab.address)
    page = found.page

    # A file that does not fit, then one that does.
    large = write(tmp_path / "large.csv", steps([3.0, 1.0], 600.0, 100.0, 6))
    assert large.stat().st_size > 2e6
    found.drop(large)
    found.wait("#uploads .finding")
    assert page.inner_text("#uploads .finding") == FULL.format("large.csv")
    assert names() == []
    page.get_by_role("button", name="Dismiss").click()
    found.drop(EXAMPLES / "ball.csv")
    found.wait("#laws .lede")
    found.settle()
    page.select_option("#shape", "ball")
    page.fill("#size-radius", "35 mm")
    page.press("#size-radius", "Tab")
    found.wait("#laws .formulas:has-text('ε(t)')")
    found.settle()

    # The rest of it is taken by something else: what is stated stays as it was, and so does the page.
    before = (inside / "ball.csv.test.toml").read_text()
    with (inside / "filler").open("wb", buffering=0) as filler, pytest.raises(OSError, match="No space"):
        while True:
            filler.write(bytes(4096))
    page.get_by_role("button", name="Remove hold 5").click()
    found.wait("#record .finding")
    assert page.inner_text("#record .finding") == FULL.format("ball.csv.test.toml")
    page.get_by_role("button", name="Calibrate on the whole record").click()
    found.wait("#grip .finding")
    assert page.inner_text("#grip .finding") == FULL.format("ball.material.toml")
    assert names() == ["ball.csv", "ball.csv.test.toml", "filler"]
    assert (inside / "ball.csv.test.toml").read_text() == before and page.locator("#holds tbody tr").count() == 5
    # A report needs no disk.
    with page.expect_download() as download:
        page.get_by_role("link", name="Report", exact=True).click()
    assert "<title>ball</title>" in Path(download.value.path()).read_text()

    (inside / "filler").unlink()
    page.get_by_role("button", name="Remove hold 5").click()
    found.wait("caption:has-text('Holds as stated')")
    found.settle()
    assert page.locator("#holds tbody tr").count() == 4 and page.locator("#record .finding").count() == 0
    page.get_by_role("button", name="Calibrate on the whole record").click()
    found.wait(".grip-panel figure")
    assert names() == ["ball.csv", "ball.csv.test.toml", "ball.material.toml"]
    found.context.close()
    lab.end()
