//! Values and derivatives by contraction: one basis (or its derivative) per variable, the slowest variable first.

use crate::kernel::accumulate;
use smallvec::SmallVec;

pub(crate) type Buffer = SmallVec<[f64; 128]>;

/// `values[k] = Σ_i basis[i] · values[i · inner + k]`, and shortened to `inner`.
pub(crate) fn contract(values: &mut Buffer, inner: usize, basis: &[f64]) {
    contract_rows(values, inner, basis);
    values.truncate(inner);
}

/// The same for the first `inner` values; the others are left as they are.
#[inline(always)]
pub(crate) fn contract_rows(values: &mut [f64], inner: usize, basis: &[f64]) {
    let (sum, rest) = values.split_at_mut(inner);
    sum.iter_mut().for_each(|v| *v *= basis[0]);
    for (row, &weight) in rest.chunks_exact(inner).zip(&basis[1..]) {
        accumulate(sum, row, weight);
    }
}

/// All partial derivatives of a map at a point, up to a total order.
///
/// ```
/// use sweepsim_spline::Bernstein;
/// let f = Bernstein::variable(2, 0).square().mul(&Bernstein::variable(2, 1)); // x² y
/// let all = f.derivatives(&[0.5, 0.25], 3);
/// assert_eq!(all.get(&[0, 0]), Some(&[0.0625][..]));
/// assert_eq!(all.get(&[1, 1]), Some(&[1.0][..])); // ∂x ∂y = 2x
/// assert_eq!(all.get(&[2, 1]), Some(&[2.0][..]));
/// assert_eq!(all.get(&[2, 2]), None); // of order 4
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Derivatives {
    order: usize,
    dimension: usize,
    variables: usize,
    indices: Vec<SmallVec<[usize; 4]>>,
    values: Vec<f64>,
    zeros: SmallVec<[f64; 4]>,
}

impl Derivatives {
    /// The derivative taken `orders[i]` times by variable `i`: one number per component.
    ///
    /// `None` beyond the total order, or unless there is one order for each variable.
    pub fn get(&self, orders: &[usize]) -> Option<&[f64]> {
        let total = orders.iter().try_fold(0usize, |sum, &order| sum.checked_add(order))?;
        if orders.len() != self.variables || total > self.order {
            return None;
        }
        match self.indices.iter().position(|index| index.as_slice() == orders) {
            Some(at) => self.values.get(at * self.dimension..(at + 1) * self.dimension),
            None => Some(&self.zeros), // of an order above a degree
        }
    }

    /// The total order up to which there are derivatives.
    pub fn order(&self) -> usize {
        self.order
    }

    /// The number of components.
    pub fn dimension(&self) -> usize {
        self.dimension
    }

    /// Every derivative that is not 0 because of a degree, with its orders, the value first.
    pub fn iter(&self) -> impl Iterator<Item = (&[usize], &[f64])> {
        self.indices
            .iter()
            .map(SmallVec::as_slice)
            .zip(self.values.chunks(self.dimension.max(1)))
    }

    /// The derivatives of the first components divided by the last, by Leibniz' rule:
    /// `F^α = (x^α − Σ_{0<β≤α} C(α,β) w^β F^{α−β}) / w`.
    pub(crate) fn quotient(&self) -> Self {
        let m = self.dimension.saturating_sub(1);
        let mut indices: Vec<SmallVec<[usize; 4]>> = vec![SmallVec::new()];
        for _ in 0..self.variables {
            let longer = |index: &SmallVec<[usize; 4]>| {
                let used: usize = index.iter().sum();
                let index = index.clone();
                (0..=self.order - used).map(move |r| {
                    let mut index = index.clone();
                    index.push(r);
                    index
                })
            };
            indices = indices.iter().flat_map(longer).collect();
        }
        sort(&mut indices);
        let mut result = Self {
            order: self.order,
            dimension: m,
            variables: self.variables,
            indices: Vec::with_capacity(indices.len()),
            values: Vec::new(),
            zeros: SmallVec::from_elem(0.0, m),
        };
        let Some(weight) = self
            .get(&SmallVec::<[usize; 4]>::from_elem(0, self.variables))
            .map(|v| v[m])
        else {
            return result;
        };
        for index in indices {
            let mut own: SmallVec<[f64; 4]> = self.get(&index).unwrap_or(&self.zeros)[..m].into();
            for (at, lower) in result.indices.iter().enumerate() {
                // `lower` is α − β: of smaller order, so it is there already.
                if lower.iter().zip(&index).any(|(l, i)| l > i) {
                    continue;
                }
                let beta: SmallVec<[usize; 4]> = index.iter().zip(lower).map(|(i, l)| i - l).collect();
                let Some(w) = self.get(&beta).map(|v| v[m]) else {
                    continue;
                };
                let choose: f64 = index
                    .iter()
                    .zip(&beta)
                    .map(|(&i, &b)| crate::kernel::binomial(i, b))
                    .product();
                for k in 0..m {
                    own[k] -= choose * w * result.values[at * m + k];
                }
            }
            result.values.extend(own.iter().map(|x| x / weight));
            result.indices.push(index);
        }
        result
    }

    /// Combines maps to R: the derivatives of each form one component.
    pub(crate) fn stack(parts: &[Self]) -> Self {
        let Some(first) = parts.first() else {
            return Self {
                order: 0,
                dimension: 0,
                variables: 0,
                indices: Vec::new(),
                values: Vec::new(),
                zeros: SmallVec::new(),
            };
        };
        let mut indices: Vec<SmallVec<[usize; 4]>> = parts.iter().flat_map(|p| p.indices.iter().cloned()).collect();
        sort(&mut indices);
        indices.dedup();
        let mut values = Vec::new();
        for index in &indices {
            for part in parts {
                values.extend_from_slice(part.get(index).unwrap_or(&part.zeros));
            }
        }
        let dimension = parts.iter().map(|p| p.dimension).sum();
        Self {
            order: first.order,
            dimension,
            variables: first.variables,
            indices,
            values,
            zeros: SmallVec::from_elem(0.0, dimension),
        }
    }
}

/// By total order, then by decreasing order in the first variable.
fn sort(indices: &mut [SmallVec<[usize; 4]>]) {
    indices.sort_by(|a, b| (a.iter().sum::<usize>(), b).cmp(&(b.iter().sum::<usize>(), a)));
}

/// The derivatives of a tensor of local coefficients, `tables[axis][r]` the `r`-th derivative of that axis's basis,
/// with as many entries as the axis is long: degree + 1.
pub(crate) fn derivatives(local: Buffer, dimension: usize, tables: &[Vec<Buffer>], order: usize) -> Derivatives {
    let n = tables.len();
    let mut parts: Vec<(SmallVec<[usize; 4]>, Buffer)> = vec![(SmallVec::from_elem(0, n), local)];
    for axis in (0..n).rev() {
        let length = tables[axis].first().map_or(1, Buffer::len);
        let mut next = Vec::new();
        for (index, tensor) in parts {
            let used: usize = index.iter().sum();
            for (r, row) in tables[axis].iter().enumerate().take((order - used + 1).min(length)) {
                let mut own = tensor.clone();
                let inner = own.len() / length;
                contract(&mut own, inner, row);
                let mut index = index.clone();
                index[axis] = r;
                next.push((index, own));
            }
        }
        parts = next;
    }
    parts.sort_by(|a, b| (a.0.iter().sum::<usize>(), &b.0).cmp(&(b.0.iter().sum::<usize>(), &a.0)));
    Derivatives {
        order,
        dimension,
        variables: n,
        zeros: SmallVec::from_elem(0.0, dimension),
        values: parts.iter().flat_map(|part| part.1.iter().copied()).collect(),
        indices: parts.into_iter().map(|part| part.0).collect(),
    }
}
