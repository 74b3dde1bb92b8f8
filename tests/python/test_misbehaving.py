"""A drawer of policies that misbehave: what each costs, what is said, and that the vehicle lands."""

import os
import re

import pytest
from short_flight import SHORT, Flight, fly

HEAD = """import ctypes, locale, os, signal, socket, subprocess, sys, threading, time
import karst

def go(request):
    return [karst.goal_at(f) for f in request.reachable()[:5]] or karst.Hold("nothing near")

class P(karst.Policy):
    \"\"\"Misbehaves.\"\"\"
    def decide(self, request):
"""
# A busy machine takes long for a second of processor time, and must not look like one that hangs.
LIMITS = {"policy.cpu_limit": "1 s", "policy.hang_limit": "60 s", "policy.memory_limit_mib": "700"}
HANGS_SOON = {"policy.hang_limit": "2 s"}
FILLS_MEMORY = {"policy.cpu_limit": "60 s"}  # on a slow machine 700 MiB take more than a second


@pytest.fixture
def drawer(small_cave, tmp_path):
    """Flies a policy whose decide() has these lines, or a file with this text."""

    def flies(lines: str = "", text: str | bytes | None = None, name: str = "mine",
              in_process: bool = False, settings: dict[str, str] | None = None, **environment) -> Flight:
        file = tmp_path / "policy" / f"{name}.py"
        file.parent.mkdir(exist_ok=True)
        if text is None:
            text = HEAD + "".join(f"        {line}\n" for line in lines.splitlines())
        file.write_bytes(text.encode() if isinstance(text, str) else text)
        options = ["--in-process"] if in_process else []
        return fly(small_cave, file, tmp_path / "run", *options, settings=SHORT | LIMITS | (settings or {}),
                   **environment)

    return flies


def failed_three_times(flight: Flight, why: str) -> None:
    """Each failed decision is held and told; the third ends the policy, and the fallback flies on."""
    assert flight.code == 0 and flight.landed
    own = [d for d in flight.of("decision") if d["policy"] == "mine"]
    assert [d["outcome"] for d in own] == ["hold", "hold"]
    assert all(why in d["reason"] and f"request {i + 1} at" in d["reason"] for i, d in enumerate(own)), own
    told = [line for line in flight.err.splitlines() if why in line]
    lines = [line for line in told if line.startswith("karst: ")]
    assert all(line.startswith(("karst: ", "  | ")) for line in told)  # the rest is what the policy printed
    assert len(lines) == 1 and "mine failed 3 times in a row" in lines[0] and "request 3 at" in lines[0]
    assert any(e["action"] == "fallback" and why in e["reason"] for e in flight.of("safety"))
    assert any(d["policy"] == "fallback" for d in flight.of("decision"))
    assert "Unable to cast" not in flight.err


def broke_twice(flight: Flight, why: str) -> None:
    """The process is started once more; the second time the fallback takes over."""
    assert flight.code == 0 and flight.landed
    first, second, *_ = [line for line in flight.err.splitlines() if why in line]
    assert "request 1" in first and "was started once more" in first
    assert "the fallback took over" in second and "request 2" in second
    assert any(e["action"] == "fallback" for e in flight.of("safety"))


def flew_as_if_nothing_were(flight: Flight) -> None:
    assert flight.code == 0 and flight.landed and "failed" not in flight.err and "broke" not in flight.err
    assert not flight.of("safety") and flight.of("plan")


def refused(flight: Flight, why: str) -> None:
    assert flight.code == 1 and not (flight.folder / "events.jsonl").exists()
    assert re.search(why, flight.err), flight.err
    assert len([line for line in flight.err.splitlines() if line.startswith("karst: ")]) == 1
    assert "Unable to cast" not in flight.err


# -- What decide() does


def test_exception(drawer):
    flight = drawer("raise ValueError('too\\nbad')")
    failed_three_times(flight, "decide(): ValueError: too (mine.py, line 10, in decide)")
    told = re.compile(r'Traceback .*\n  File ".*/mine.py", line 10, in decide\n    raise ValueError')
    assert len(told.findall(flight.printed)) == 3
    log = "\n".join(e["text"].removeprefix("warning: ") for e in flight.of("log"))
    assert told.search(log) and "ValueError: too\nbad" in log


def test_a_single_exception_is_forgiven(drawer):
    flight = drawer("if request.sequence in (1, 2, 4): raise ValueError('now and then')\nreturn go(request)")
    assert flight.code == 0 and flight.landed and not flight.of("safety")
    assert flight.printed.count("Traceback") == 3


def test_endless_loop(drawer):
    broke_twice(drawer("while True: pass"), "decide() took more than 1 s of processor time")


def test_sleeping_for_ever(drawer):
    broke_twice(drawer("time.sleep(1e6)", settings=HANGS_SOON), "decide() did not return within 2 s")


def test_memory_hog(drawer):
    flight = drawer("x = []\nwhile True: x.append(bytearray(50 << 20))", settings=FILLS_MEMORY)
    failed_three_times(flight, "MemoryError (mine.py, line 11")


def test_crash_in_an_extension(drawer):
    flight = drawer("print('my last words')\nctypes.string_at(0)")
    broke_twice(flight, "request")
    assert "SIGSEGV" in flight.err and "Segmentation fault" in flight.err
    assert flight.printed.count("my last words") == 2  # stdout is line-buffered


def test_os_exit(drawer):
    broke_twice(drawer("os._exit(0)"), "exit code 0")


def test_sys_exit(drawer):
    failed_three_times(drawer("sys.exit(3)"), "SystemExit: 3 (mine.py, line 10")


def test_keyboard_interrupt(drawer):
    failed_three_times(drawer("raise KeyboardInterrupt"), "KeyboardInterrupt (mine.py, line 10")


def test_threads_left_behind(drawer):
    flight = drawer(
        "def spin():\n"
        "    while True: time.sleep(0.001)\n"
        "if request.sequence == 1:\n"
        "    threading.Thread(target=lambda: time.sleep(1e6)).start()\n"
        "    threading.Thread(target=spin, daemon=True).start()\n"
        "return go(request)")
    flew_as_if_nothing_were(flight)


def test_a_thread_that_asks_the_map_when_decide_is_over(drawer):
    """The map may be asked on any thread, but not after its request: that would read freed memory."""
    flight = drawer(
        "def ask():\n"
        "    for _ in range(20):\n"
        "        try: print('answer', request.map.cells(request.position))\n"
        "        except karst.Error as e: return print('refused', e)\n"
        "        time.sleep(0.01)\n"
        "threading.Thread(target=ask, daemon=True).start()\n"
        "time.sleep(0.03)\n"
        "return go(request)")
    flew_as_if_nothing_were(flight)
    assert flight.printed.startswith("answer [1]\n")
    assert "refused this request has ended: keep what it said, or request.map.retained()" in flight.printed


def test_fork(drawer):
    failed_three_times(drawer("os.fork()"), "PermissionError: [Errno 1] Operation not permitted (mine.py, line 10")


def test_reaching_out(drawer, tmp_path):
    secret = tmp_path / "secret.txt"
    secret.write_text("secret")
    flight = drawer(
        f"tries = dict(write=lambda: open('{tmp_path}/written', 'w'), own=lambda: open(__file__ + 'x', 'w'),\n"
        f"    read=lambda: open('{secret}').read(), shadow=lambda: open('/etc/shadow').read(),\n"
        f"    mkdir=lambda: os.mkdir('{tmp_path}/made'), remove=lambda: os.remove(__file__), tcp=socket.socket,\n"
        "    run=lambda: subprocess.run(['/bin/true']), kill=lambda: os.kill(os.getppid(), 0),\n"
        "    chmod=lambda: os.chmod(__file__, 0o777), own_text=lambda: open(__file__).read(6))\n"
        "for name, act in tries.items():\n"
        "    try: print(name, 'did', act())\n"
        "    except Exception as e: print(name, type(e).__name__)\n"
        "return go(request)")
    flew_as_if_nothing_were(flight)
    told = dict(line.split(" ", 1) for line in flight.printed.splitlines()[:11])
    assert told.pop("own_text") == "did import"
    reading = {told.pop("read"), told.pop("shadow")}
    if not any(note in flight.err for note in ("Landlock", "landlock")):
        assert reading == {"PermissionError"}
    assert set(told.values()) == {"PermissionError"} and len(told) == 8, told
    assert sorted(f.name for f in tmp_path.iterdir()) == ["policy", "run", "secret.txt"]


def test_os_system_does_nothing(drawer, tmp_path):
    flight = drawer(f"print(os.system('touch {tmp_path}/made') != 0)\nreturn go(request)")
    flew_as_if_nothing_were(flight)
    assert flight.printed.startswith("True\n") and not (tmp_path / "made").exists()


def test_locale(drawer):
    flew_as_if_nothing_were(drawer("locale.setlocale(locale.LC_ALL, 'C.UTF-8')\nreturn go(request)"))


def test_signals(drawer):
    """Python gives the signals of a process to the thread that started it; elsewhere it refuses."""
    flight = drawer(
        "for s in (signal.SIGSEGV, signal.SIGXCPU, signal.SIGTERM):\n"
        "    try: signal.signal(s, signal.SIG_IGN)\n"
        "    except ValueError as e: print(e)\n"
        "return go(request)")
    flew_as_if_nothing_were(flight)


def test_recursion(drawer):
    failed_three_times(drawer("self.decide(request)"), "RecursionError: maximum recursion depth exceeded (mine.py")


def test_recursion_without_a_limit(drawer):
    flight = drawer("sys.setrecursionlimit(10**9)\nself.decide(request)")
    assert flight.code == 0 and flight.landed and "the fallback took over" in flight.err


# -- What decide() returns


@pytest.mark.parametrize("answer, why", [
    ("'north'", "TypeError: an answer is goals, karst.Tour, karst.Hold, karst.Explored or karst.GoHome, not a str"),
    ("karst.Goal([1, 2])", "TypeError: goal 0: position has the shape (2,), not (3,)"),
    ("karst.Goal([float('nan')] * 3)", "no goal was well formed: goal 1: its position is not finite"),
    ("karst.Hold('two\\nlines\\x07')", "its reason has control characters or more than one line"),
    ("karst.Hold('\\ud800')", "ValueError: reason holds a character that is none"),
])
def test_wrong_answers(drawer, answer, why):
    flight = drawer(f"return {answer}")
    failed_three_times(flight, why)
    assert "Traceback" not in flight.printed  # of karst's own code


def test_nan_among_good_goals(drawer):
    flight = drawer("return [karst.Goal([float('nan')] * 3), *go(request)]")
    assert flight.code == 0 and flight.landed and not flight.of("safety") and flight.of("plan")
    assert any("mine: goal 1: its position is not finite" in e["text"] for e in flight.of("log"))


def test_a_million_goals(drawer):
    flight = drawer("goals = [karst.goal_at(request.reachable()[0])]\n"
                    "return goals * (1000000 if request.sequence == 1 else 1)")
    assert flight.code == 0 and flight.landed
    assert "of 1000000 goals only the first 64 are offered" in [e["text"][:46] for e in flight.of("log")] or (
        "processor time" in flight.err)  # a limit of one second


def test_giant_texts_are_cut(drawer):
    flight = drawer("goals = go(request)\n"
                    "return karst.Fly([karst.Goal(request.position, why='ä' * 10**6)], 'x' * 10**6)")
    assert flight.code == 0 and flight.landed and not flight.of("safety")
    assert any("2 texts are cut to 240 bytes" in e["text"] for e in flight.of("log"))
    assert flight.of("decision")[0]["reason"] == "x" * 240


def test_control_characters_in_why(drawer):
    flight = drawer("f = request.reachable()[0]\nreturn [karst.goal_at(f, why='a\\x1b[31m\\nb\\0')]")
    assert flight.code == 0 and flight.landed
    assert "\x1b" not in flight.out + flight.err + (flight.folder / "events.jsonl").read_text()


def test_printing_megabytes(drawer):
    flight = drawer("for i in range(30000): print('line', i, 'x' * 100)\nreturn go(request)")
    flew_as_if_nothing_were(flight)
    assert (1 << 20) <= len(flight.printed) < (1 << 20) + 200
    assert flight.printed.splitlines()[0].startswith("line 0 x")


def test_each_line_is_printed_at_once_whatever_the_locale(drawer):
    flight = drawer("print('Höhle →', 1)\nprint('\\ud800')\nsys.stderr.write('ß\\n')\nreturn go(request)",
                    LC_ALL="C", PYTHONIOENCODING="ascii")
    flew_as_if_nothing_were(flight)
    assert flight.printed.splitlines()[:3] == ["Höhle → 1", "\\ud800", "ß"]


def test_exceptions_beside_decide(drawer):
    """What is raised in an event, or in save(), costs no decision; it is told."""
    flight = drawer(text=HEAD + "        return go(request)\n"
                    "    def on_event(self, event): raise KeyError('event')\n"
                    "    def save(self): raise KeyError('save')\n")
    assert flight.code == 0 and flight.landed and flight.of("plan")
    assert "KeyError: 'event'" in flight.printed and "KeyError: 'save'" in flight.printed


# -- In karst's own process


def test_in_process_exceptions_end_the_same_way(drawer):
    """The same decisions and messages as in a process of its own."""
    apart = drawer("raise ValueError('bad')")
    kept = apart.events
    within = drawer("raise ValueError('bad')", in_process=True)
    assert within.code == 0 and within.landed and within.events == kept
    assert "ValueError: bad (mine.py, line 10, in decide), request 3" in within.err


def test_in_process_endless_loop_is_abandoned(drawer):
    flight = drawer("while True: pass", in_process=True)
    assert flight.code == 0 and flight.landed and "the fallback took over" in flight.err


def test_in_process_crash_names_the_request(drawer):
    flight = drawer("ctypes.string_at(0)", in_process=True)
    assert flight.code < 0 and "crashed in decide(), request 1 (SIGSEGV)" in flight.err


# -- What is in the file


@pytest.mark.parametrize("text, why", [
    ("import karst\nclass P(karst.Policy:\n    pass\n", r"mine.py: mine.py, line 2: SyntaxError: "),
    ("import karst\nimport no_such_module_at_all\n",
     r"ModuleNotFoundError: No module named 'no_such_module_at_all' \(mine.py, line 2, in <module>\)"),
    ("import karst\n", r"mine.py: holds no policy: a class that derives from karst.Policy, or a function decide"),
    ("", r"mine.py: holds no policy"),
    ("import karst\nclass A(karst.Policy):\n    def decide(self, r): return karst.Hold('a')\n"
     "class BeeTwo(karst.Policy):\n    def decide(self, r): return karst.Hold('b')\n",
     r"holds several policies: name one of a, bee_two, and give --plugin .*mine.py"),
    (b"\0\0", r"null bytes"),
    (b"import karst\nx = '\xe9'\n", r"SyntaxError: "),
    ("raise RuntimeError('at once')\n", r"RuntimeError: at once \(mine.py, line 1, in <module>\)"),
    ("import sys\nsys.exit(0)\n", r"SystemExit: 0 \(mine.py, line 2"),
    ("import os\nos._exit(0)\n", r"mine.py: ended the process when opened"),
    ("import ctypes\nctypes.string_at(0)\n", r"mine.py: .*(crash|signal|SIGSEGV)"),
    (HEAD + "        return go(request)\n    version = 3\n", r"the version of P is 3, not a text"),
    (HEAD + "        return go(request)\n    id = 3\n", r"the id of P is 3, not a text"),
    (HEAD + "        return go(request)\n    id = 'Not good'\n", r"'Not good' is no id of a policy: small letters"),
    (HEAD + "        return go(request)\n    x = karst.Real(5, 0, 1, 'm', 'far')\n", r"the default is out of range"),
    (HEAD + "        return go(request)\n    def init(self): raise karst.Error('a and b contradict')\n",
     r"init\(\): a and b contradict \(mine.py, line 11, in init\)"),
    (HEAD + "        return go(request)\n    def __init__(self): raise KeyError('made')\n",
     r"create\(\): KeyError: 'made' \(mine.py, line 11, in __init__\)"),
])
def test_files_that_are_refused(drawer, text, why):
    flight = drawer(text=text)
    assert flight.code == 1 and not (flight.folder / "events.jsonl").exists()
    assert re.search(why, flight.err), flight.err
    assert "Unable to cast" not in flight.err


def test_a_file_name_that_is_no_id(drawer):
    refused(drawer("return go(request)", name="My-Nearest"), r"'My-Nearest' is no id of a policy")


def test_a_file_that_never_ends_to_open(drawer):
    refused(drawer(text="while True: pass\n"), "opening it hangs")


def test_one_of_two_policies_flies_by_its_name(drawer, small_cave, tmp_path):
    file = tmp_path / "both.py"
    file.write_text("import karst\nclass A(karst.Policy):\n    def decide(self, r): return karst.Hold('of a')\n"
                    "class BeeTwo(karst.Policy):\n    def decide(self, r): return karst.Hold('of b')\n")
    flight = fly(small_cave, "bee_two", tmp_path / "run", "--plugin", file)
    assert flight.code == 0 and flight.of("decision")[0]["reason"] == "of b"


def test_a_folder_a_large_file_and_one_without_rights(small_cave, tmp_path):
    folder = tmp_path / "x.py"
    folder.mkdir()
    large = tmp_path / "large.py"
    large.write_bytes(b"#" * (20 << 20))
    for policy, why in ((folder, "x.py"), (large, "large.py: .*(MiB|large|bytes)"), (tmp_path / "none.py", "none.py")):
        flight = fly(small_cave, policy, tmp_path / "run")
        refused(flight, why)
    locked = tmp_path / "locked.py"
    locked.write_text("import karst\n")
    locked.chmod(0)
    if os.access(locked, os.R_OK):
        pytest.skip("this user may read everything")
    refused(fly(small_cave, locked, tmp_path / "run"), "locked.py: .*(ermission|cannot be read)")


def test_a_path_with_letters_that_are_not_ascii(small_cave, tmp_path):
    folder = tmp_path / "Höhle"
    folder.mkdir()
    file = folder / "mine.py"
    file.write_text(HEAD + "        print(len(open(__file__).read()) > 0, 'ä')\n        return go(request)\n")
    flew_as_if_nothing_were(fly(small_cave, file, tmp_path / "run", LC_ALL="C"))
