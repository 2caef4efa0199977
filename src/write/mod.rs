//! Font → Files: TTF, OTF, WOFF2, UFO, SVG, proof.
