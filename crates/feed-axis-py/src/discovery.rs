//! What a search found.

use std::path::PathBuf;

use pyo3::prelude::*;
use pyo3::types::{PyDict, PyModule, PyTuple};

use crate::axis::PyAxis;
use crate::errors::{SearchError, package, raise};
use crate::html::{page_to, table};
use crate::motion_program::Program;
use crate::value::{Value, value};

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
    /// The page of the search, which shows more than the words and figures hold.
    page: String,
}

impl Discovery {
    /// With the text of the axis file that has the effects, and the page.
    pub(crate) fn new(found: discrepancy::Discovery, text: String, page: String) -> PyResult<Self> {
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
            page,
        })
    }

    fn first(&self) -> Option<&Parameter> {
        self.effects.first().and_then(|e| e.parameters.first())
    }
}

impl Value for Discovery {
    fn state<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        let json = serde_json::to_string(&self.found).map_err(raise::<SearchError>)?;
        (json, &self.text, &self.page).into_pyobject(py)
    }

    fn restored(state: &Bound<'_, PyTuple>) -> PyResult<Self> {
        let (json, text, page): (String, String, String) = state.extract()?;
        let found = serde_json::from_str(&json).map_err(raise::<SearchError>)?;
        Self::new(found, text, page)
    }

    /// The page shows the same.
    fn key<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        let json = serde_json::to_string(&self.found).map_err(raise::<SearchError>)?;
        (json, &self.text).into_pyobject(py)
    }
}

value!(Discovery, hash);

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
    fn next_experiment(&self) -> PyResult<Option<Program>> {
        let next = self.found.next_experiment.as_ref();
        next.map(|next| Program::of(&next.program)).transpose()
    }

    /// All of it, as `discovery.json` of the command has it.
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let text = serde_json::to_string(&self.found).map_err(raise::<SearchError>)?;
        PyModule::import(py, "json")?.call_method1("loads", (text,))
    }

    /// The numbers of the effects as a pandas DataFrame, a row each.
    fn to_pandas<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let rows = || {
            let effects = self.effects.iter();
            effects.flat_map(|e| e.parameters.iter().map(move |p| (e, p)))
        };
        let columns = PyDict::new(py);
        let texts = |of: fn((&Effect, &Parameter)) -> String| rows().map(of).collect::<Vec<_>>();
        let numbers = |of: fn(&Parameter) -> f64| rows().map(|(_, p)| of(p)).collect::<Vec<_>>();
        columns.set_item("effect", texts(|(effect, _)| effect.name.clone()))?;
        columns.set_item("parameter", texts(|(_, p)| p.name.clone()))?;
        columns.set_item("value", numbers(|p| p.value))?;
        columns.set_item("from", numbers(|p| p.interval.0))?;
        columns.set_item("to", numbers(|p| p.interval.1))?;
        columns.set_item("unit", texts(|(_, p)| p.unit.clone()))?;
        let pandas = package(py, "pandas", "to_pandas")?;
        pandas.getattr("DataFrame")?.call1((columns,))
    }

    /// The page of the search, as the command writes it; to a file too where one is named.
    #[pyo3(signature = (path = None))]
    fn to_html(&self, py: Python<'_>, path: Option<PathBuf>) -> PyResult<String> {
        page_to(py, self.page.clone(), path)
    }

    /// Draws the gap before and after, and the noise, with matplotlib.
    #[pyo3(signature = (*, ax = None))]
    fn plot<'py>(
        slf: &Bound<'py, Self>,
        ax: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let plots = slf.py().import("feed_axis._plot")?;
        plots.call_method1("plot_discovery", (slf, ax))
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
