//! Guaranteed subdivision solvers: points, curves, surfaces, and charts for families of systems
