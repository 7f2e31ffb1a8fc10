//! The paper's printed tables, to stand beside ours.

use std::path::Path;

use miette::{IntoDiagnostic, Result, WrapErr};

/// Maximum and mean, as printed, µm.
pub type Pair = [f64; 2];

/// One trajectory's printed figures.
#[derive(Clone, Default)]
pub struct Row {
    pub model: Pair,
    pub experiment: Pair,
    pub predicted_network: Pair,
    pub predicted_transfer: Pair,
    pub network: Pair,
    pub transfer: Pair,
    pub network_lugre: Pair,
    pub transfer_lugre: Pair,
}

/// All tables that the report shows.
#[derive(Clone, Default)]
pub struct Tables {
    pub trajectories: Vec<Row>,
    /// Table 11: maximum and mean, µm.
    pub network: Pair,
    /// Tables 7 to 10: maximum and mean in mm, in the order of the study.
    pub study: Vec<Pair>,
}

/// Reads the tables from a folder of CSV files.
pub fn read(folder: &Path) -> Result<Tables> {
    let t13 = numbers(&folder.join("table13_model_vs_experiment.csv"), 1)?;
    let t14 = numbers(&folder.join("table14_prediction.csv"), 1)?;
    let t15 = numbers(&folder.join("table15_compensation_lugre.csv"), 1)?;
    let t16 = numbers(&folder.join("table16_compensation_no_lugre.csv"), 1)?;
    let t11 = numbers(&folder.join("table11_cfnn_final.csv"), 5)?;
    let study = numbers(&folder.join("table07_10_cfnn_study.csv"), 2)?;
    let pair = |row: &[f64], at: usize| match row.get(at..at + 2) {
        Some(&[max, mean]) => [max, mean],
        _ => [f64::NAN; 2],
    };
    let row = |i: usize| Row {
        experiment: pair(&t13[i], 0),
        model: pair(&t13[i], 2),
        predicted_network: pair(&t14[i], 2),
        predicted_transfer: pair(&t14[i], 4),
        network_lugre: pair(&t15[i], 2),
        transfer_lugre: pair(&t15[i], 4),
        network: pair(&t16[i], 0),
        transfer: pair(&t16[i], 2),
    };
    let count = [&t13, &t14, &t15, &t16].map(|t| t.len()).into_iter().min();
    Ok(Tables {
        trajectories: (0..count.unwrap_or(0)).map(row).collect(),
        network: t11.first().map_or([f64::NAN; 2], |row| pair(row, 0)),
        study: study.iter().map(|row| pair(row, 0)).collect(),
    })
}

/// The columns of a CSV file from `skip` on, as far as they are numbers.
fn numbers(path: &Path, skip: usize) -> Result<Vec<Vec<f64>>> {
    let mut reader = csv::Reader::from_path(path)
        .into_diagnostic()
        .wrap_err_with(|| format!("cannot read the paper's table {}", path.display()))?;
    let mut rows = Vec::new();
    for record in reader.records() {
        let record = record.into_diagnostic()?;
        let fields = record.iter().skip(skip);
        rows.push(
            fields
                .map_while(|field| field.trim().parse().ok())
                .collect(),
        );
    }
    Ok(rows)
}
