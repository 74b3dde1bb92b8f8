"""Writes messages of interop.mjs into db3 by Python's SQLite: write_db3.py MESSAGES.jsonl OUT.db3"""
import base64
import json
import sqlite3
import sys

lines = open(sys.argv[1], encoding="utf8").read().split("\n")
db = sqlite3.connect(sys.argv[2])
db.execute("CREATE TABLE schema(schema_version INTEGER PRIMARY KEY, ros_distro TEXT NOT NULL)")
db.execute("INSERT INTO schema VALUES(4, 'jazzy')")
db.execute("CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, "
           "serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL, type_description_hash TEXT NOT NULL)")
db.execute("CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp INTEGER NOT NULL, "
           "data BLOB NOT NULL)")
db.execute("CREATE INDEX timestamp_idx ON messages (timestamp ASC)")
for i, t in enumerate(json.loads(lines[0])):
    db.execute("INSERT INTO topics VALUES(?, ?, ?, 'cdr', '', '')", (i + 1, t["topic"], t["type"]))
for line in lines[1:]:
    topic, time, data = json.loads(line)
    db.execute("INSERT INTO messages(topic_id, timestamp, data) VALUES(?, ?, ?)",
               (topic + 1, int(time), base64.b64decode(data)))
db.commit()
db.close()
