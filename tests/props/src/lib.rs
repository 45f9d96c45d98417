//! proptest with a runner that is compiled once.
//!
//! The runner of proptest is generic over the strategy and the test: made anew for every property, it is a third of
//! what test crates compile. Here values travel in boxes. `proptest!` takes what tests of this workspace write:
//! functions of `pattern in strategy`, with an optional configuration.

use std::any::Any;
use std::fmt::{self, Debug, Formatter};
use test_runner::{Config, TestCaseResult, TestRunner};

pub use proptest::prelude::*;
pub use proptest::{collection, strategy, test_runner};

/// Functions that hold for all values of their strategies, as `proptest::proptest!`.
#[macro_export]
macro_rules! proptest {
    (#![proptest_config($config:expr)]
     $(
        $(#[$meta:meta])*
        fn $name:ident($($pattern:pat in $strategy:expr),+ $(,)?) $body:block
    )*) => {
        $(
            $(#[$meta])*
            fn $name() {
                let mut config = $crate::test_runner::contextualize_config($config);
                config.test_name = Some(concat!(module_path!(), "::", stringify!($name)));
                config.source_file = Some(file!());
                let names = concat!($(stringify!($pattern), ", "),+);
                $crate::check(config, names, ($($strategy,)+), |($($pattern,)+)| {
                    let (): () = $body;
                    Ok(())
                });
            }
        )*
    };
    ($(#[$meta:meta])* fn $($tests:tt)*) => {
        $crate::proptest! { #![proptest_config($crate::test_runner::Config::default())] $(#[$meta])* fn $($tests)* }
    };
}

/// A value that a failing test shows.
trait Value: Any + Debug {}
impl<T: Any + Debug> Value for T {}

/// The values of one case.
struct Case {
    names: &'static str,
    values: Box<dyn Value>,
}

impl Debug for Case {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "({}) = {:?}", self.names.trim_end_matches(", "), self.values)
    }
}

/// Panics with the smallest values found for which the test fails. `names` are those of the values.
#[doc(hidden)]
pub fn check<S>(config: Config, names: &'static str, strategy: S, test: impl Fn(S::Value) -> TestCaseResult)
where
    S: Strategy + 'static,
    S::Value: 'static,
{
    let cases = strategy.prop_map(move |values| Case {
        names,
        values: Box::new(values),
    });
    run(config, &cases.boxed(), &|case| {
        let values: Box<dyn Any> = case.values;
        test(*values.downcast().expect("made of these values"))
    });
}

/// [`check`], whatever the values are.
fn run(config: Config, cases: &BoxedStrategy<Case>, test: &dyn Fn(Case) -> TestCaseResult) {
    let mut runner = TestRunner::new(config);
    if let Err(error) = runner.run(cases, test) {
        panic!("{error}\n{runner}");
    }
}
