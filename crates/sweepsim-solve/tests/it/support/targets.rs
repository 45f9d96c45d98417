//! Targets of charts and bundles, and what is found of them.

use sweepsim_solve::{ChartTarget, Enclosure, Preimage, Sink, Targets, UnresolvedTarget};

/// Targets, each in its own row.
pub struct List<const N: usize>(pub Vec<[f64; N]>);

impl<const N: usize> Targets<N> for List<N> {
    fn count(&self, range: &[Enclosure; N]) -> usize {
        let inside = |q: &&[f64; N]| (0..N).all(|i| range[i].contains(q[i]));
        self.0.iter().filter(inside).count()
    }

    fn visit(
        &self,
        range: &[Enclosure; N],
        narrow: &dyn Fn(&[f64; N]) -> Option<Enclosure>,
        visit: &mut dyn FnMut(&ChartTarget<N>) -> bool,
    ) {
        for (number, value) in self.0.iter().enumerate() {
            let target = ChartTarget {
                number,
                place: [number, 0],
                value: *value,
            };
            let wanted =
                (0..N).all(|i| range[i].contains(value[i])) && narrow(value).is_some_and(|w| w.contains(value[1]));
            if wanted && !visit(&target) {
                return;
            }
        }
    }
}

/// What a solver handed out.
#[derive(Default)]
pub struct Answer<const N: usize> {
    pub found: Vec<Preimage<N>>,
    pub open: Vec<UnresolvedTarget<N>>,
}

impl<const N: usize> Sink<N> for Answer<N> {
    fn found(&mut self, preimage: Preimage<N>) {
        self.found.push(preimage);
    }

    fn mark(&self) -> usize {
        self.found.len()
    }

    fn forget(&mut self, mark: usize) {
        self.found.truncate(mark);
    }

    fn forget_targets(&mut self, mark: usize, targets: &[usize]) {
        let later = self.found.split_off(mark);
        let is_kept = |found: &Preimage<N>| targets.binary_search(&found.target).is_err();
        self.found.extend(later.into_iter().filter(is_kept));
    }

    fn unresolved(&mut self, target: UnresolvedTarget<N>) {
        self.open.push(target);
    }
}
