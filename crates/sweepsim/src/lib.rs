//! Exact swept volumes of milling tools along 5-axis motions, as dexels
