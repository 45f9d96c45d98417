//! Dexel grids: exact intervals on parallel lines, coverage counting, stock, and surfaces from dexels
