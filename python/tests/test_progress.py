"""Long calls: how far they are, how they are stopped, and that others go on meanwhile."""

import signal
import subprocess
import sys
import textwrap
import threading
import time

import numpy as np
import pytest

import shapespace


def test_a_callable_hears_how_far_a_call_is(poses, animal):
    heard = []
    shapespace.interpolate(
        poses, animal.faces, shapes=1, progress=lambda *arguments: heard.append(arguments)
    )
    assert heard
    for stage, done, total, share in heard:
        assert isinstance(stage, str) and isinstance(done, int) and isinstance(total, int)
        assert share is None or 0 <= share <= 1
    assert any(share for *_, share in heard)


def test_false_stops_and_gives_the_best_so_far(poses, animal):
    def stop(stage, done, total, share):
        return share is None or share < 0.3

    path, summary = shapespace.interpolate(poses, animal.faces, progress=stop)
    assert summary.termination == "cancelled" and not path.converged
    assert len(path) == 17


def test_false_at_once_is_an_exception(poses, animal):
    with pytest.raises(shapespace.Cancelled):
        shapespace.interpolate(poses, animal.faces, progress=lambda *_: False)


def test_what_a_callable_raises_comes_out(poses, animal, path):
    class Mine(Exception):
        pass

    def fail(stage, done, total, share):
        raise Mine(stage)

    with pytest.raises(Mine):
        shapespace.interpolate(poses, animal.faces, progress=fail)
    with pytest.raises(Mine):
        shapespace.extrapolate(path, 3, progress=fail)
    with pytest.raises(Mine):
        shapespace.distance_matrix(poses, animal.faces, progress=fail)
    with pytest.raises(Mine):
        shapespace.transfer(path, poses[0], progress=fail)


def test_a_callable_may_call_the_library(poses, animal):
    inner = []

    def nested(stage, done, total, share):
        if not inner:
            inner.append(shapespace.interpolate(poses, animal.faces, shapes=1).path)

    outer = shapespace.interpolate(poses, animal.faces, shapes=1, progress=nested).path
    np.testing.assert_array_equal(inner[0].vertices, outer.vertices)


def test_true_shows_a_bar(poses, animal, capsys):
    shapespace.interpolate(poses, animal.faces, shapes=1, progress=True)
    assert "%" in capsys.readouterr().err


def test_true_shows_a_line_without_tqdm(poses, animal, capsys, monkeypatch):
    monkeypatch.setitem(sys.modules, "tqdm.auto", None)
    shapespace.interpolate(poses, animal.faces, shapes=1, progress=True)
    assert "%" in capsys.readouterr().err


def test_what_is_no_callable_is_refused(poses, animal):
    with pytest.raises(TypeError, match="progress: must be a callable"):
        shapespace.interpolate(poses, animal.faces, progress=3)


def test_other_threads_go_on(poses, animal):
    """Without the interpreter's lock released, a second thread would hardly get a turn."""
    turns = 0
    done = threading.Event()

    def count():
        nonlocal turns
        while not done.wait(0.002):
            turns += 1

    thread = threading.Thread(target=count)
    thread.start()
    begin = time.monotonic()
    shapespace.interpolate(poses, animal.faces, tolerance=1e-9, max_iterations=5000)
    seconds = time.monotonic() - begin
    done.set()
    thread.join()
    assert turns > 0.1 * seconds / 0.002


def test_two_threads_find_the_same(poses, animal):
    found = [None, None]

    def solve(i):
        found[i] = shapespace.interpolate(poses, animal.faces, shapes=3).path.vertices

    threads = [threading.Thread(target=solve, args=(i,)) for i in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    np.testing.assert_array_equal(*found)


@pytest.mark.parametrize("delay", [0.1, 0.5, 1.0])
@pytest.mark.parametrize(
    "call",
    [
        "shapespace.interpolate(poses, tolerance=1e-12, max_iterations=10**6)",
        "shapespace.distance_matrix([body.pose(n) for n in body.pose_names], body)",
    ],
)
def test_ctrl_c_stops_a_call(delay, call):
    script = f"""
        import signal, time
        import shapespace
        signal.signal(signal.SIGINT, signal.default_int_handler)
        body = shapespace.skinned_body("quadruped", 4000)
        poses = shapespace.Poses([body.pose("sit"), body.pose("stretch")], body)
        print("ready", flush=True)
        try:
            while True:
                {call}
        except KeyboardInterrupt:
            print(time.monotonic(), flush=True)
    """
    process = subprocess.Popen(
        [sys.executable, "-c", textwrap.dedent(script)], stdout=subprocess.PIPE, text=True
    )
    assert process.stdout.readline() == "ready\n"
    time.sleep(delay)
    sent = time.monotonic()
    process.send_signal(signal.SIGINT)
    rest, _ = process.communicate(timeout=60)
    assert process.returncode == 0
    # A quarter of a second of it is for a machine that is busy with other things.
    assert float(rest) - sent < 0.2 + 0.25


@pytest.mark.parametrize("method", ["fork", "spawn"])
def test_processes_work_after_a_call(method, poses, animal, tmp_path):
    """TBB's threads are not there in a forked child; it must work all the same."""
    script = tmp_path / "processes.py"
    script.write_text(
        textwrap.dedent(f"""
            import multiprocessing
            import shapespace

            def solve(names):
                body = shapespace.skinned_body("quadruped", 1500)
                poses = [body.pose(name) for name in names]
                return shapespace.interpolate(poses, body, shapes=1).summary.energy

            if __name__ == "__main__":
                pairs = [("sit", "stretch"), ("stand", "rear")]
                here = [solve(pair) for pair in pairs]
                with multiprocessing.get_context("{method}").Pool(2) as pool:
                    there = pool.map(solve, pairs)
                assert here == there
            """)
    )
    subprocess.run([sys.executable, script], check=True, timeout=60)
