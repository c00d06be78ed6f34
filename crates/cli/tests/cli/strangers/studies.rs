//! Studies, figures and reproduction.
