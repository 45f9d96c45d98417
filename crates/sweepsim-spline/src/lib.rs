//! Multivariate tensor-product B-splines and Bernstein forms, rational or not, and their algebra
