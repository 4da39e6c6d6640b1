//! Oracles, generators and comparison shared by the tests of every crate.
