//! Mathematics without pictures; imports nothing of ours.
