//! What a search found.

use pyo3::prelude::*;
use pyo3::types::PyModule;

use crate::axis::PyAxis;
use crate::errors::{SearchError, raise};
use crate::html::table;
use crate::motion::Program;

/// A number of an effect, with its 95 % interval.
#[pyclass(module = "feed_axis", frozen, get_all, skip_from_py_object)]
#[derive(Clone)]
pub(crate) struct Parameter {
    /// Name.
    name: String,
    /// Estimate, in `unit`.
    value: f64,
    /// SI unit.
    unit: String,
    /// 95 % interval.
    interval: (f64, f64),
}

#[pymethods]
impl Parameter {
    fn __repr__(&self) -> String {
        let (from, to) = self.interval;
        format!(
            "Parameter({} = {:.5e} {}, 95 %: {from:.5e} to {to:.5e})",
            self.name, self.value, self.unit
        )
    }
}

/// An effect that was named.
#[pyclass(module = "feed_axis", frozen, get_all, skip_from_py_object)]
#[derive(Clone)]
pub(crate) struct Effect {
    /// Name, as in the axis file.
    name: String,
    /// One line for people.
    summary: String,
    /// Its numbers.
    parameters: Vec<Parameter>,
    /// Effects that these logs cannot tell from it.
    indistinguishable_from: Vec<String>,
    /// Channel in which it shows first.
    channel: String,
    /// Share of the check logs' gap that comes back without it.
    share_of_gap: f64,
}

#[pymethods]
impl Effect {
    fn __repr__(&self) -> String {
        let numbers: Vec<String> = self.parameters.iter().map(Parameter::__repr__).collect();
        format!("Effect({:?}, {})", self.name, numbers.join(", "))
    }
}

/// What a model lacks: verdict, effects with their sizes, words, and the model with them.
#[pyclass(module = "feed_axis", frozen)]
pub(crate) struct Discovery {
    found: discrepancy::Discovery,
    effects: Vec<Effect>,
    text: String,
}

impl Discovery {
    /// With the text of the axis file that has the effects.
    pub(crate) fn new(found: discrepancy::Discovery, text: String) -> PyResult<Self> {
        let effects = found.effects.iter().map(|e| Effect {
            name: e.name.clone(),
            summary: e.summary.clone(),
            parameters: (e.parameters.iter())
                .map(|p| Parameter {
                    name: p.name.clone(),
                    value: p.value,
                    unit: p.unit.clone(),
                    interval: (p.ci95[0], p.ci95[1]),
                })
                .collect(),
            indistinguishable_from: e.indistinguishable_from.clone(),
            channel: e.channel.clone(),
            share_of_gap: e.share_of_gap,
        });
        let effects = effects.collect();
        Ok(Self {
            effects,
            found,
            text,
        })
    }

    fn first(&self) -> Option<&Parameter> {
        self.effects.first().and_then(|e| e.parameters.first())
    }
}

#[pymethods]
impl Discovery {
    /// "explained", "partly-explained", "other-form", "nothing-missing" or "unknown".
    #[getter]
    fn verdict(&self) -> &'static str {
        self.found.verdict.name()
    }

    /// The named effects, largest share first.
    #[getter]
    fn effects(&self) -> Vec<Effect> {
        self.effects.clone()
    }

    /// Their names.
    #[getter]
    fn names(&self) -> Vec<&str> {
        self.effects.iter().map(|e| e.name.as_str()).collect()
    }

    /// First number of the first effect, SI; `None` if nothing was named.
    #[getter]
    fn size(&self) -> Option<f64> {
        self.first().map(|p| p.value)
    }

    /// Its 95 % interval.
    #[getter]
    fn interval(&self) -> Option<(f64, f64)> {
        self.first().map(|p| p.interval)
    }

    /// Its unit.
    #[getter]
    fn unit(&self) -> Option<&str> {
        self.first().map(|p| p.unit.as_str())
    }

    /// The verdict in a sentence.
    #[getter]
    fn sentence(&self) -> &str {
        &self.found.sentence
    }

    /// The sentence, and what a first screen says beside it.
    #[getter]
    fn words(&self) -> String {
        let mut text = self.found.sentence.clone();
        for answered in self.found.first_screen() {
            text += &format!("\n\n{}", answered.question);
            for line in &answered.lines {
                text += &format!("\n  {line}");
            }
        }
        text
    }

    /// What was done to the logs, and what must be known of them.
    #[getter]
    fn notes(&self) -> Vec<String> {
        self.found.notes.clone()
    }

    /// RMS gap on motion that was not fitted to, by channel: before, after, and noise.
    #[getter]
    fn gap(&self) -> Vec<(String, f64, f64, f64)> {
        let channels = self.found.gap.check.channels.iter();
        channels
            .map(|c| (c.channel.to_string(), c.before, c.after, c.floor))
            .collect()
    }

    /// The axis with what was found added to it.
    #[getter]
    fn axis(&self) -> PyResult<PyAxis> {
        PyAxis::parsed("<axis with what was found>", self.text.clone())
    }

    /// The motion to run next, where effects look alike.
    #[getter]
    fn next_experiment(&self) -> Option<Program> {
        let next = self.found.next_experiment.as_ref()?;
        Some(Program(next.program.clone()))
    }

    /// All of it, as `discovery.json` of the command has it.
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let text = serde_json::to_string(&self.found).map_err(raise::<SearchError>)?;
        PyModule::import(py, "json")?.call_method1("loads", (text,))
    }

    fn _repr_html_(&self) -> String {
        let rows = self.effects.iter().flat_map(|effect| {
            let row = |p: &Parameter| {
                let interval = format!("{:.5e} to {:.5e}", p.interval.0, p.interval.1);
                let value = format!("{:.5e}", p.value);
                vec![
                    effect.name.clone(),
                    p.name.clone(),
                    value,
                    interval,
                    p.unit.clone(),
                ]
            };
            effect.parameters.iter().map(row)
        });
        let heads = ["effect", "parameter", "value", "95 % interval", "unit"];
        table(&self.found.sentence, &heads, &rows.collect::<Vec<_>>())
    }

    fn __repr__(&self) -> String {
        let effects: Vec<String> = self.effects.iter().map(Effect::__repr__).collect();
        format!("Discovery({}: [{}])", self.verdict(), effects.join(", "))
    }
}
