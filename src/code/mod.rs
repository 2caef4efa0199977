//! Contours → bits: vertex-based shape coding by rate and distortion.
