//! Readers and writers for milling simulation: jobs, NC programs, meshes, dexels, reports
