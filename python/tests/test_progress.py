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


def test_a_callable_may_call_the_library_while_all_threads_solve(poses, animal):
    inner = []

    def nested(stage, done, total, share):
        inner.append(shapespace.interpolate(poses, animal.faces, shapes=1).summary.energy)
        return len(inner) < 4

    several = [*poses, 0.5 * (poses[0] + poses[1])]
    with pytest.raises(shapespace.Cancelled):
        shapespace.distance_matrix(several, animal.faces, progress=nested)
    assert len(set(inner)) == 1


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


BIG = 20000  # triangles; some steps of solvers take much longer than .2 s
CALLS = {
    "interpolate": "shapespace.interpolate(poses)",
    "extrapolate": "shapespace.extrapolate(path, 20)",
    "transport": "shapespace.transport(path, [path[1] - path[0]])",
    "transfer": "shapespace.transfer(path, other)",
    "deform": "shapespace.deform(poses[0], body, handles)",
    "correspond": "shapespace.correspond(poses[0], body, other, body, markers)",
    "distance_matrix": "shapespace.distance_matrix(poses, resolution=0)",
    "explore": "shapespace.explore(poses, resolution=0)",
    "film strip": "shapespace.film_strip(path)",  # of what reports no progress
}


def in_process(triangles, begin, then="", first=""):
    """A process that does `begin`, with arguments for CALLS at hand, says so, and does `then`."""
    script = f"""
{first}
import itertools, multiprocessing, signal, time
import numpy as np
import shapespace
signal.signal(signal.SIGINT, signal.default_int_handler)
small = shapespace.skinned_body("quadruped", 1500)
def solve(name, progress=None):
    poses = [small.pose("sit"), small.pose(name)]
    return shapespace.interpolate(poses, small, shapes=1, progress=progress).path[1]
body = shapespace.skinned_body("quadruped", {triangles})
other = shapespace.skinned_body("quadruped", {triangles}, proportions="long").pose("sit")
poses = shapespace.Poses([body.pose("sit"), body.pose("stretch")], body)
path = shapespace.Path([0.9 * poses[0] + 0.1 * poses[1], poses[1]], shapespace.Metric(poses))
path = path.at(np.linspace(0, 1, 5))
handles = [shapespace.Handle([0]), shapespace.Handle([1], translation=(0, 0.1, 0))]
chosen = np.unique([np.argmax(poses[0] @ d) for d in itertools.product((-1, 0.3, 1), repeat=3)])
markers = np.stack([chosen, chosen], axis=1)
{textwrap.dedent(begin)}
print("ready", flush=True)
{textwrap.dedent(then)}
"""
    process = subprocess.Popen(
        [sys.executable, "-c", script], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    assert process.stdout.readline() == "ready\n"
    return process


@pytest.mark.parametrize("call", CALLS)
def test_ctrl_c_stops_a_call_at_once(call):
    process = in_process(
        BIG,
        "before = solve('stretch')",
        f"""
        try:
            while True:
                {CALLS[call]}
        except KeyboardInterrupt:
            print(time.monotonic(), flush=True)
        np.testing.assert_array_equal(solve("stretch"), before)
        """,
    )
    time.sleep(0.5)
    sent = time.monotonic()
    process.send_signal(signal.SIGINT)
    rest, _ = process.communicate(timeout=60)
    assert process.returncode == 0
    # Half a second of it is for a machine that is busy with other things.
    assert float(rest) - sent < 0.2 + 0.5


def test_a_process_may_end_while_an_abandoned_call_still_runs():
    process = in_process(5 * BIG, "", CALLS["deform"])
    time.sleep(0.5)
    process.send_signal(signal.SIGINT)
    _, error = process.communicate(timeout=60)
    assert process.returncode == -signal.SIGINT
    assert error.splitlines()[-1] == "KeyboardInterrupt"


@pytest.mark.parametrize(
    "call",
    [
        "solve('stretch')",
        "solve('stretch', lambda *_: None)",
        # Lets others run Python meanwhile, as a callback does that writes to a terminal.
        "solve('stretch', lambda *_: time.sleep(0.03))",
        "shapespace.Metric(poses)",
    ],
)
@pytest.mark.parametrize("slow", [0, 0.2])
def test_a_process_may_end_while_daemon_threads_call(slow, call):
    """Some have begun to before, others begin when it ends and the interpreter is still there."""
    first = f"""
import atexit, threading, time
exiting = threading.Event()
def exit():
    exiting.set()
    time.sleep({slow})
class Last:
    def __del__(self, sleep=time.sleep):
        sleep({slow})
atexit.register(exit)
last = Last()
"""
    calls = f"""
        def calls(waits):
            if waits:
                exiting.wait()
            while True:
                {call}
        for waits in 3 * [False, True]:
            threading.Thread(target=calls, args=[waits], daemon=True).start()
    """
    process = in_process(4000, calls, "time.sleep(0.3)", first)
    _, error = process.communicate(timeout=60)
    assert process.returncode == 0 and error == ""


def test_a_process_may_fork_while_an_abandoned_call_still_runs():
    """The child would lack the thread, but have the locks that it holds."""
    process = in_process(
        5 * BIG,
        "here = solve('stretch')",
        f"""
        try:
            {CALLS["deform"]}
        except KeyboardInterrupt:
            with multiprocessing.get_context("fork").Pool(2) as pool:
                for there in pool.map(solve, ["stretch", "stretch"]):
                    np.testing.assert_array_equal(there, here)
            print("interrupted")
        """,
    )
    time.sleep(0.5)
    process.send_signal(signal.SIGINT)
    rest, _ = process.communicate(timeout=60)
    assert process.returncode == 0 and rest == "interrupted\n"


class Alarm(Exception):
    pass


@pytest.fixture
def alarm():
    """Raises Alarm in the main thread after so many seconds."""

    def ring(number, frame):
        raise Alarm

    before = signal.signal(signal.SIGALRM, ring)
    yield lambda seconds: signal.setitimer(signal.ITIMER_REAL, seconds)
    signal.setitimer(signal.ITIMER_REAL, 0)
    signal.signal(signal.SIGALRM, before)


@pytest.fixture(scope="module")
def big():
    """A body, its rest shape and handles, of which a deformation takes some seconds."""
    body = shapespace.skinned_body("quadruped", 5 * BIG)
    handles = [shapespace.Handle([0]), shapespace.Handle([1], translation=(0, 0.1, 0))]
    return body, body.pose("stand"), handles


def test_a_call_that_waits_for_an_abandoned_one_can_be_stopped_too(alarm, big, poses, animal):
    body, rest, handles = big
    before = shapespace.interpolate(poses, animal.faces, shapes=1).path.vertices
    mesh = shapespace.Poses([rest], body)
    for seconds in (0.5, 0.1):
        alarm(seconds)
        begin = time.monotonic()
        with pytest.raises(Alarm):
            if seconds == 0.5:
                shapespace.deform(mesh[0], mesh, handles)
            while True:
                shapespace.interpolate(poses, animal.faces, shapes=1)
        assert time.monotonic() - begin < seconds + 0.2 + 0.5
    after = shapespace.interpolate(poses, animal.faces, shapes=1).path.vertices
    np.testing.assert_array_equal(after, before)


def test_a_deformer_serves_again_after_an_abandoned_call(alarm, animal):
    rest = animal.pose("stand")
    handles = [
        shapespace.Handle(rest[:, 1] < 0.1),
        shapespace.Handle([np.argmax(rest[:, 2])], translation=(0, 0.3, 0)),
    ]
    expected = shapespace.deform(rest, animal, handles, tolerance=1e-9).path.vertices
    deformer = shapespace.Deformer(rest, animal, tolerance=1e-9)
    for seconds in (0.001, 0.01, 0.03):
        alarm(seconds)
        with pytest.raises(Alarm):
            while True:
                deformer.deform(handles)
                deformer = shapespace.Deformer(rest, animal, tolerance=1e-9)
    np.testing.assert_array_equal(deformer.deform(handles).path.vertices, expected)


def test_callables_run_in_the_thread_of_the_call(poses, animal):
    idents = set()

    def solve():
        shapespace.interpolate(
            poses, animal.faces, shapes=1, progress=lambda *_: idents.add(threading.get_ident())
        )

    solve()
    assert idents == {threading.get_ident()}
    idents.clear()
    thread = threading.Thread(target=solve)
    thread.start()
    thread.join()
    assert idents == {thread.ident}


def test_other_threads_go_on_when_the_main_thread_is_stopped(alarm, poses, animal):
    options = {"tolerance": 1e-9, "max_iterations": 5000}
    found = []
    thread = threading.Thread(
        target=lambda: found.append(shapespace.interpolate(poses, animal.faces, **options).path)
    )
    thread.start()
    alarm(0.1)
    with pytest.raises(Alarm):
        while True:
            shapespace.interpolate(poses, animal.faces, **options)
    thread.join()
    again = shapespace.interpolate(poses, animal.faces, **options).path
    np.testing.assert_array_equal(found[0].vertices, again.vertices)


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


def test_what_is_stopped_before_there_is_a_path_is_cancelled(poses, animal):
    with pytest.raises(shapespace.Cancelled):
        shapespace.interpolate(poses, animal.faces, progress=lambda *told: False)
