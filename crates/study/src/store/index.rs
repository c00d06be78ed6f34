//! The index of a store: the state of each run as its files tell it, for fast look-up, and the leases.
//!
//! It holds no fact about runs beyond their files: it can be deleted, and is made again from them. The leases are in
//! it alone; losing them costs work that is done twice to the same bits, and no result.

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::time::Duration;

use rusqlite::types::{FromSql, FromSqlError, FromSqlResult, ToSql, ToSqlOutput, ValueRef};
use rusqlite::{
    Connection, OpenFlags, OptionalExtension, Transaction, TransactionBehavior, params,
};

use super::entry::{Entry, Lease, State};
use super::owner::{Owner, now};
use crate::error::{Result, StudyError};
use crate::identity::Identity;

/// Layout of the tables; an index of another is made again.
const LAYOUT: i32 = 1;
/// How long to wait for another process that writes.
const BUSY: Duration = Duration::from_secs(60);

/// An open index.
#[derive(Debug)]
pub(crate) struct Index {
    path: PathBuf,
    connection: Connection,
}

const TABLES: &str = include_str!("index/tables.sql");

/// Selects the entries of all runs.
const ENTRIES: &str = "SELECT identity, state, reason, row, transition_time, stamp FROM runs";
/// The same without rows and stamps, which are most of it.
const FINDINGS: &str = "SELECT identity, state, reason, NULL, transition_time, NULL FROM runs";

/// Bytes of a path that SQLite opens, with its journal beside it.
const LONGEST_PATH: usize = 500;

impl Index {
    /// Opens the index, and answers whether it is new and has to be filled from the files.
    pub(crate) fn open(path: &Path) -> Result<(Self, bool)> {
        match Self::try_open(path) {
            Err(StudyError::Index { source, .. }) if is_damaged(&source) => {
                // It is only an index: what it held is in the files.
                super::set_aside(path)?;
                Self::try_open(path)
            }
            outcome => outcome,
        }
    }

    /// Opens the index of a store that cannot be written to, to look at it as it stands. `refusal` is the error of opening it
    /// to write, and stays the error where nothing is there that can be read.
    pub(crate) fn open_to_read(path: &Path, refusal: StudyError) -> Result<Self> {
        match &refusal {
            StudyError::Index { .. } if refusal.is_closed() => {}
            _ => return Err(refusal),
        }
        let opened = Connection::open_with_flags(path, OpenFlags::SQLITE_OPEN_READ_ONLY).ok();
        let is_ours = |connection: &Connection| layout(connection).is_ok_and(|it| it == LAYOUT);
        let connection = opened.filter(is_ours).ok_or(refusal)?;
        let path = path.to_owned();
        Ok(Self { path, connection })
    }

    fn try_open(path: &Path) -> Result<(Self, bool)> {
        let folder = path.parent().and_then(|folder| folder.canonicalize().ok());
        let length = folder.map_or(0, |folder| {
            folder
                .join(path.file_name().unwrap_or_default())
                .as_os_str()
                .len()
        });
        if length > LONGEST_PATH {
            let reason = format!(
                "its path has {length} bytes, and an index opens with {LONGEST_PATH} at most"
            );
            let error = std::io::Error::new(std::io::ErrorKind::InvalidFilename, reason);
            return Err(StudyError::io("open", path)(error));
        }
        let mut connection = Connection::open(path).map_err(failed(path))?;
        let is_new = prepare(&mut connection).map_err(failed(path))?;
        let path = path.to_owned();
        Ok((Self { path, connection }, is_new))
    }

    fn read<T>(&self, answer: impl FnOnce(&Connection) -> rusqlite::Result<T>) -> Result<T> {
        answer(&self.connection).map_err(failed(&self.path))
    }

    /// The entries of all runs that are not merely pending.
    pub(crate) fn entries(&self) -> Result<HashMap<Identity, Entry>> {
        self.read(|connection| select_entries(connection, ENTRIES))
    }

    /// The same without rows and stamps.
    pub(crate) fn findings(&self) -> Result<HashMap<Identity, Entry>> {
        self.read(|connection| select_entries(connection, FINDINGS))
    }

    /// The entry of a run.
    pub(crate) fn entry(&self, identity: Identity) -> Result<Option<Entry>> {
        let query = format!("{ENTRIES} WHERE identity = ?1");
        let entry_of = |row: &rusqlite::Row<'_>| entry_from(row).map(|(_, entry)| entry);
        self.read(|connection| {
            connection
                .query_row(&query, [identity], entry_of)
                .optional()
        })
    }

    /// All leases that hold.
    pub(crate) fn leases(&self, timeout: Duration) -> Result<HashMap<Identity, Lease>> {
        let mut leases = self.read(all_leases)?;
        leases.retain(|_, lease| !lease.is_void(timeout));
        Ok(leases)
    }

    /// Notes the entries of runs.
    pub(crate) fn note<'a>(
        &mut self,
        entries: impl IntoIterator<Item = (Identity, &'a Entry)>,
    ) -> Result<()> {
        self.change(|transaction| {
            for (identity, entry) in entries {
                put(transaction, identity, entry)?;
            }
            Ok(())
        })
    }

    /// Replaces all entries by these, which were read from the files. Leases stay, and so do entries that other processes have
    /// noted since `before`, when the reading of the files began.
    pub(crate) fn replace(
        &mut self,
        entries: &HashMap<Identity, Entry>,
        before: &HashMap<Identity, Entry>,
    ) -> Result<()> {
        self.change(|transaction| {
            let now = select_entries(transaction, FINDINGS)?;
            let state_in = |entries: &HashMap<Identity, Entry>, identity: &Identity| {
                entries.get(identity).map(|entry| entry.state)
            };
            let is_news = |identity: &Identity| {
                now.contains_key(identity) && state_in(&now, identity) != state_in(before, identity)
            };
            for identity in now.keys().filter(|identity| !is_news(identity)) {
                transaction.execute("DELETE FROM runs WHERE identity = ?1", [identity])?;
            }
            for (identity, entry) in entries.iter().filter(|(identity, _)| !is_news(identity)) {
                put(transaction, *identity, entry)?;
            }
            transaction.pragma_update(None, "user_version", LAYOUT)
        })
    }

    /// Takes a lease of the first run in this order that is neither finished nor failed nor leased.
    pub(crate) fn claim(
        &mut self,
        order: &[Identity],
        owner: &Owner,
        timeout: Duration,
    ) -> Result<Claim> {
        let Owner {
            host,
            process,
            started,
            token,
        } = owner;
        self.change(|transaction| {
            let entries = select_entries(transaction, FINDINGS)?;
            let leases = all_leases(transaction)?;
            let mut others = 0;
            for identity in order {
                let state = entries.get(identity).map(|entry| entry.state);
                if matches!(state, Some(State::Done | State::Failed)) {
                    continue;
                }
                if let Some(lease) = leases.get(identity)
                    && !lease.is_void(timeout)
                {
                    others += 1;
                    continue;
                }
                transaction.execute(
                    "INSERT OR REPLACE INTO leases VALUES (?1, ?2, ?3, ?4, ?5, ?6)",
                    params![identity, host, process, started, token, now()],
                )?;
                return Ok(Claim::Taken(*identity));
            }
            Ok(match others {
                0 => Claim::Nothing,
                leased => Claim::Wait { leased },
            })
        })
    }

    /// Renews every lease of this owner, and answers which runs it holds.
    pub(crate) fn renew(&mut self, owner: &Owner) -> Result<Vec<Identity>> {
        self.change(|transaction| {
            transaction.execute(
                "UPDATE leases SET heartbeat = ?1 WHERE token = ?2",
                params![now(), owner.token],
            )?;
            let mut held = transaction.prepare("SELECT identity FROM leases WHERE token = ?1")?;
            let held = held.query_map([&owner.token], |row| row.get(0))?;
            held.collect()
        })
    }

    /// Notes the entry of a run and gives its lease back; answers false, and does neither, where the lease is no
    /// longer this owner's.
    pub(crate) fn release(
        &mut self,
        identity: Identity,
        owner: &Owner,
        entry: Option<&Entry>,
    ) -> Result<bool> {
        self.change(|transaction| {
            let given = transaction.execute(
                "DELETE FROM leases WHERE identity = ?1 AND token = ?2",
                params![identity, owner.token],
            )?;
            if let Some(entry) = entry
                && given > 0
            {
                put(transaction, identity, entry)?;
            }
            Ok(given > 0)
        })
    }

    fn change<T>(
        &mut self,
        action: impl FnOnce(&Transaction<'_>) -> rusqlite::Result<T>,
    ) -> Result<T> {
        let begin = TransactionBehavior::Immediate;
        let transaction = self.connection.transaction_with_behavior(begin);
        let outcome = transaction.and_then(|transaction| {
            let outcome = action(&transaction)?;
            transaction.commit()?;
            Ok(outcome)
        });
        outcome.map_err(failed(&self.path))
    }
}

fn failed(path: &Path) -> impl FnOnce(rusqlite::Error) -> StudyError {
    let path = path.to_owned();
    |source| StudyError::Index { path, source }
}

/// Outcome of asking for work.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Claim {
    /// This run is now ours.
    Taken(Identity),
    /// All that is left is leased.
    Wait {
        /// How many.
        leased: usize,
    },
    /// Nothing is left.
    Nothing,
}

fn layout(connection: &Connection) -> rusqlite::Result<i32> {
    connection.pragma_query_value(None, "user_version", |row| row.get(0))
}

fn prepare(connection: &mut Connection) -> rusqlite::Result<bool> {
    connection.busy_timeout(BUSY)?;
    let transaction = connection.transaction_with_behavior(TransactionBehavior::Immediate)?;
    let layout = layout(&transaction)?;
    if layout != 0 && layout != LAYOUT {
        transaction.execute_batch("DROP TABLE IF EXISTS runs; DROP TABLE IF EXISTS leases;")?;
    }
    transaction.execute_batch(TABLES)?;
    // The layout is noted only when the index has been filled, so that a scan cut short is done again.
    transaction.commit()?;
    // Found here, damage can still be mended; later it would end a study.
    let verdict: String = connection.pragma_query_value(None, "quick_check", |row| row.get(0))?;
    if verdict != "ok" {
        return Err(rusqlite::Error::SqliteFailure(
            rusqlite::ffi::Error::new(rusqlite::ffi::SQLITE_CORRUPT),
            Some(verdict),
        ));
    }
    // A flipped bit in a value leaves a whole database with an impossible entry.
    select_entries(connection, ENTRIES)?;
    all_leases(connection)?;
    Ok(layout != LAYOUT)
}

/// Whether the database is damaged, rather than out of reach.
fn is_damaged(error: &rusqlite::Error) -> bool {
    use rusqlite::ErrorCode;
    match error.sqlite_error_code() {
        // `Unknown` is an error in a statement. Ours are right, so the tables are not ours.
        Some(code) => matches!(
            code,
            ErrorCode::DatabaseCorrupt | ErrorCode::NotADatabase | ErrorCode::Unknown
        ),
        // A value that we never write.
        None => true,
    }
}

impl ToSql for Identity {
    fn to_sql(&self) -> rusqlite::Result<ToSqlOutput<'_>> {
        Ok(self.to_string().into())
    }
}

impl FromSql for Identity {
    fn column_result(value: ValueRef<'_>) -> FromSqlResult<Self> {
        let identity = value.as_str()?.parse();
        identity.map_err(FromSqlError::other::<crate::NotAnIdentity>)
    }
}

fn entry_from(row: &rusqlite::Row<'_>) -> rusqlite::Result<(Identity, Entry)> {
    let state: String = row.get(1)?;
    let entry = Entry {
        state: State::of_name(&state),
        reason: row.get(2)?,
        row: row.get(3)?,
        transition_time: row.get(4)?,
        stamp: row.get(5)?,
    };
    Ok((row.get(0)?, entry))
}

fn select_entries(
    connection: &Connection,
    query: &str,
) -> rusqlite::Result<HashMap<Identity, Entry>> {
    let mut statement = connection.prepare(query)?;
    statement.query_map([], entry_from)?.collect()
}

fn all_leases(connection: &Connection) -> rusqlite::Result<HashMap<Identity, Lease>> {
    let mut statement = connection
        .prepare("SELECT identity, host, process, started, token, heartbeat FROM leases")?;
    let rows = statement.query_map([], |row| {
        let lease = Lease {
            owner: Owner {
                host: row.get(1)?,
                process: row.get(2)?,
                started: row.get(3)?,
                token: row.get(4)?,
            },
            heartbeat: row.get(5)?,
        };
        Ok((row.get(0)?, lease))
    })?;
    rows.collect()
}

fn put(connection: &Connection, identity: Identity, entry: &Entry) -> rusqlite::Result<()> {
    let (state, tau) = (entry.state.name(), entry.transition_time);
    connection.execute(
        "INSERT OR REPLACE INTO runs VALUES (?1, ?2, ?3, ?4, ?5, ?6)",
        params![identity, state, entry.reason, entry.row, tau, entry.stamp],
    )?;
    Ok(())
}

#[cfg(test)]
mod tests;
