//! What holds of every menu of methods.

use serde::{Serialize, de::DeserializeOwned};
use std::collections::BTreeSet;
use std::fmt::Debug;

/// The default comes first; methods differ in their keys and say something of themselves; options are plain values
/// that have defaults, and no others are taken.
pub(crate) fn is_complete<M>(
    methods: &[M],
    key: fn(&M) -> &'static str,
    about: fn(&M) -> &'static str,
) where
    M: Default + PartialEq + Debug + Serialize + DeserializeOwned,
{
    let default = M::default();
    assert_eq!(methods.first(), Some(&default), "the default comes first");
    for m in methods {
        let key = key(m);
        assert!(!about(m).is_empty(), "{key} says nothing of itself");
        let short = format!("method = \"{key}\"");
        let text = toml::to_string(m).expect("options are plain values");
        assert!(text.contains(&short), "{text}");
        let read = |text: &str| toml::from_str::<M>(text);
        assert_eq!(read(&text).as_ref(), Ok(m), "what was written reads back");
        assert_eq!(read(&short).as_ref(), Ok(m), "options have defaults");
        let wrong = read(&format!("{short}\nno-such-option = 1"));
        assert!(wrong.is_err(), "{key} takes an unknown option");
    }
    let keys: BTreeSet<_> = methods.iter().map(key).collect();
    assert_eq!(keys.len(), methods.len(), "keys differ");
}
