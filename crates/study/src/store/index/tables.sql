CREATE TABLE IF NOT EXISTS runs (
    identity TEXT PRIMARY KEY,
    state TEXT NOT NULL,
    reason TEXT,
    row TEXT,
    transition_time REAL,
    stamp TEXT
) WITHOUT ROWID;
CREATE TABLE IF NOT EXISTS leases (
    identity TEXT PRIMARY KEY,
    host TEXT NOT NULL,
    process INTEGER NOT NULL,
    started TEXT NOT NULL,
    token TEXT NOT NULL,
    heartbeat INTEGER NOT NULL
) WITHOUT ROWID;
