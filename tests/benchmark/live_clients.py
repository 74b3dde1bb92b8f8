"""Clients of `karst fly --live`, good and bad, of the standard library alone: see live_jitter.sh.

    live_clients.py PORT RESULT_FILE

Runs until it is ended, and then writes what it did into RESULT_FILE.
"""
import base64, json, os, signal, socket, struct, sys, threading, time

PORT, RESULT = int(sys.argv[1]), sys.argv[2]
counts = {"messages": 0, "bytes": 0, "attacks": 0, "dead connections": 0}
over = threading.Event()


def connected():
    while not over.is_set():
        try:
            return socket.create_connection(("127.0.0.1", PORT), timeout=5)
        except OSError:
            time.sleep(0.2)
    sys.exit()


def frame(opcode, payload):
    mask, n = os.urandom(4), len(payload)
    length = bytes([0x80 | n]) if n < 126 else struct.pack("!BH", 0x80 | 126, n) if n < 65536 else struct.pack(
        "!BQ", 0x80 | 127, n)
    return bytes([0x80 | opcode]) + length + mask + bytes(b ^ mask[i % 4] for i, b in enumerate(payload))


def upgraded(s):
    key = base64.b64encode(os.urandom(16)).decode()
    s.sendall((f"GET / HTTP/1.1\r\nHost: 127.0.0.1:{PORT}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Key: {key}\r\n"
               "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Protocol: foxglove.websocket.v1\r\n\r\n").encode())
    stream = s.makefile("rb")
    while stream.readline().strip():
        pass
    return stream


def subscribe(s):
    s.sendall(frame(1, json.dumps({"op": "subscribe", "subscriptions": [{"id": i, "channelId": i} for i in range(13)]}).encode()))


def follow():
    while not over.is_set():
        try:
            s = connected()
            stream = upgraded(s)
            s.settimeout(None)
            subscribe(s)
            while head := stream.read(2):
                n = head[1] & 127
                n = struct.unpack("!H", stream.read(2))[0] if n == 126 else struct.unpack("!Q", stream.read(8))[0] if n == 127 else n
                payload = stream.read(n)
                if head[0] & 15 == 9:
                    s.sendall(frame(10, payload))
                counts["messages"] += 1
                counts["bytes"] += n
        except OSError:
            pass
        time.sleep(0.2)


def dead():
    while not over.is_set():
        try:
            s = connected()
            s.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
            upgraded(s)
            subscribe(s)
            counts["dead connections"] += 1
            over.wait(40)
        except OSError:
            pass


def attack():
    while not over.is_set():
        try:
            for kind in range(4):
                s = connected()
                if kind == 0:
                    s.sendall(os.urandom(5000))
                elif kind == 1:
                    s.sendall(b"GET / HT")
                    held.append(s)
                    del held[:-100]
                elif kind == 2:
                    upgraded(s)
                    s.sendall(struct.pack("!BBQ", 0x82, 0x80 | 127, 1 << 40) + bytes(5000))
                else:
                    upgraded(s)
                    for _ in range(30):
                        s.sendall(frame(1, b'{"op":"subscribe","subscriptions":[{"id":-1,"channelId":99}]}'))
                counts["attacks"] += 1
        except OSError:
            pass


held = []


def end(*_):
    with open(RESULT, "w") as out:
        out.write(", ".join(f"{n} {what}" for what, n in counts.items()) + "\n")
    os._exit(0)


signal.signal(signal.SIGTERM, end)
for what in [follow] * 5 + [dead] * 2 + [attack]:
    threading.Thread(target=what, daemon=True).start()
while True:
    time.sleep(1)
