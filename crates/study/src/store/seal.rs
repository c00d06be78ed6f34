//! The seal of a finished run: which products it has, and their hashes. Written last, it makes a run done.

use std::path::Path;

use peristalsis_formats::{atomic, hexadecimal};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use crate::error::Result;
use crate::identity::{Identity, PHYSICS_VERSION};

/// Name of the file by which a run is finished.
pub const SEAL: &str = "done.json";

/// A product: its name, size and hash.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
struct Product {
    name: String,
    bytes: u64,
    sha256: String,
}

/// The seal.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
struct Contents {
    identity: String,
    physics_version: u32,
    products: Vec<Product>,
}

/// The products of a finished run.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Seal {
    contents: Contents,
    /// Of the contents, so that the seal itself is guarded too.
    sha256: String,
}

impl Contents {
    fn hash(&self) -> String {
        let text = serde_json::to_string(self).expect("names and numbers always serialise");
        hexadecimal(&Sha256::digest(text.as_bytes()))
    }
}

impl Seal {
    /// Seals products that have been written to a folder.
    pub(crate) fn write(
        folder: &Path,
        identity: Identity,
        products: &[(&str, Vec<u8>)],
    ) -> Result<()> {
        let contents = Contents {
            identity: identity.to_string(),
            physics_version: PHYSICS_VERSION,
            products: products
                .iter()
                .map(|(name, bytes)| Product {
                    name: (*name).to_owned(),
                    bytes: bytes.len() as u64,
                    sha256: hexadecimal(&Sha256::digest(bytes)),
                })
                .collect(),
        };
        let seal = Self {
            sha256: contents.hash(),
            contents,
        };
        let mut text =
            serde_json::to_string_pretty(&seal).expect("names and numbers always serialise");
        text.push('\n');
        Ok(atomic::write(&folder.join(SEAL), text.as_bytes())?)
    }

    /// Reads a seal; `Err` says in a sentence why it is invalid.
    pub(crate) fn read(folder: &Path, identity: Identity) -> Result<Self, String> {
        let text = std::fs::read_to_string(folder.join(SEAL))
            .map_err(|error| format!("{SEAL} cannot be read: {error}"))?;
        let seal: Self = serde_json::from_str(&text)
            .map_err(|error| format!("{SEAL} is not a seal: {error}"))?;
        if seal.contents.hash() != seal.sha256 {
            return Err(format!("{SEAL} does not match its own hash"));
        }
        if seal.contents.identity != identity.to_string() {
            return Err(format!("{SEAL} is that of run {}", seal.contents.identity));
        }
        // Names come from a file: none of them may lead out of the folder.
        let leads_out = |name: &&str| name.contains(['/', '\\']) || name.starts_with('.');
        if let Some(name) = seal.names().find(leads_out) {
            return Err(format!("{SEAL} names {name:?}"));
        }
        Ok(seal)
    }

    /// Names of the products.
    pub(crate) fn names(&self) -> impl Iterator<Item = &str> {
        let products = self.contents.products.iter();
        products.map(|product| product.name.as_str())
    }

    /// Checks the hash of every product; `Err` is a sentence on the first that differs.
    pub(crate) fn check(&self, folder: &Path) -> Result<(), String> {
        for product in &self.contents.products {
            let name = &product.name;
            let bytes = std::fs::read(folder.join(name))
                .map_err(|error| format!("{name} cannot be read: {error}"))?;
            let (found, sealed) = (bytes.len() as u64, product.bytes);
            if found != sealed {
                return Err(format!("{name} has {found} bytes, sealed were {sealed}"));
            }
            if hexadecimal(&Sha256::digest(&bytes)) != product.sha256 {
                return Err(format!("{name} does not match its hash"));
            }
        }
        Ok(())
    }

    /// Sizes and times of change of seal and products: while they stay, hashes that checked once need not be computed
    /// again. `None` where a file is missing.
    pub(crate) fn stamp(&self, folder: &Path) -> Option<String> {
        let mut stamp = String::new();
        for name in self.names().chain([SEAL]) {
            let metadata = std::fs::metadata(folder.join(name)).ok()?;
            let changed = metadata.modified().ok()?;
            let since = changed
                .duration_since(std::time::UNIX_EPOCH)
                .map_or(0, |since| since.as_nanos());
            stamp.push_str(&format!("{name} {} {since}\n", metadata.len()));
        }
        Some(hexadecimal(&Sha256::digest(stamp.as_bytes())[..16]))
    }
}
