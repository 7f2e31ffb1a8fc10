//! A case as files: the C code, samples, what Rust makes of them, and a program that compares.

use std::path::Path;
use std::process::Command;

use axis_pipeline::strategies::Predictors;
use axis_scalar::Scalar;
use compensator::{Guard, GuardLimits, Sample, Status, Trip};
use controller_export::ExportedController;
use controller_export::c::{self, CSource, Precision};

use super::Outcome;
use super::laws::{LIMITS, Runs, double, single};
use super::samples::{Event, event, samples};

/// Writes NAME.c, NAME.h, check.c and cases.bin into a folder.
pub fn write(
    folder: &Path,
    predictors: &Predictors,
    name: &str,
    precision: Precision,
    cycles: usize,
) -> Outcome<CSource> {
    let controller = ExportedController::of(predictors, name, LIMITS)?;
    write_one(folder, predictors, &controller, precision, (cycles, true))
}

/// The same of a controller with limits of its own, over a number of cycles; `strict` refuses those
/// in which too little happens.
pub fn write_one(
    folder: &Path,
    predictors: &Predictors,
    controller: &ExportedController,
    precision: Precision,
    (cycles, strict): (usize, bool),
) -> Outcome<CSource> {
    let source = c::export(controller, precision, None)?;
    let samples = samples(&predictors.axis, cycles, source.look_ahead.unwrap_or(1))?;
    let count = samples.len();
    let course = Course {
        samples: &samples,
        happens: &|k, sample| event(k, count, sample),
        strict,
    };
    write_course(folder, predictors, controller, precision, &course)?;
    Ok(source)
}

/// Samples, and what happens before each.
pub struct Course<'a> {
    pub samples: &'a [Sample],
    pub happens: &'a dyn Fn(usize, &mut Sample) -> Event,
    /// Whether too little may not happen.
    pub strict: bool,
}

/// The same along a course.
pub fn write_course(
    folder: &Path,
    predictors: &Predictors,
    controller: &ExportedController,
    precision: Precision,
    course: &Course<'_>,
) -> Outcome<()> {
    let (name, limits) = (&*controller.name, &controller.limits);
    let source = c::export(controller, precision, None)?;
    let cases = match precision {
        Precision::F64 => {
            let law = double(predictors, name, &controller.law)?;
            cases(law, &source, course, limits)?
        }
        Precision::F32 => {
            let law = controller.law.cast::<f32>()?;
            cases(single(&law)?, &source, course, limits)?
        }
    };
    std::fs::create_dir_all(folder)?;
    let check = include_str!("check.c").replace("@X@", name);
    let stack = include_str!("stack.c").replace("@X@", name);
    let real = format!("#define REAL {}\n", precision.name());
    std::fs::write(folder.join(&source.header.name), &source.header.text)?;
    std::fs::write(folder.join(&source.source.name), &source.source.text)?;
    std::fs::write(folder.join("stack.c"), real.clone() + &stack)?;
    std::fs::write(folder.join("check.c"), real + &check)?;
    std::fs::write(folder.join("cases.bin"), cases)?;
    Ok(())
}

/// Event and inputs of each cycle, and the corrections that Rust makes.
fn cases<'a, T: Scalar>(
    mut law: Box<dyn Runs<T> + 'a>,
    source: &CSource,
    course: &Course<'_>,
    limits: &GuardLimits,
) -> Outcome<Vec<u8>> {
    let samples = course.samples;
    let mut guard = Guard::new(limits.cast())?;
    let mut bytes = Vec::new();
    let (mut seen, mut corrected) = ([0; 6], 0);
    for (k, sample) in samples.iter().enumerate() {
        let mut sample = *sample;
        let happens = (course.happens)(k, &mut sample);
        match happens {
            Event::None => {}
            Event::On => guard.switch(true),
            Event::Off => guard.switch(false),
            Event::Reset => {
                law.reset();
                guard.restart();
            }
        }
        let sample = sample.cast::<T>();
        let was_planned = law.is_planned();
        let asked = law.correct(&sample);
        if law.is_planned() && !was_planned {
            guard.restart();
        }
        let made = guard.pass(&asked, law.surprise());
        if !law.is_planned() && guard.status() == Status::On {
            guard.restart();
        }
        if law.begins_anew(&asked) {
            guard.restart();
        }
        law.passed(&made);
        bytes.extend((happens as u32).to_le_bytes());
        bytes.extend(status(guard.status()).to_le_bytes());
        for input in &source.inputs {
            push(&mut bytes, input.of(&sample));
        }
        push(&mut bytes, made.position);
        push(&mut bytes, made.command);
        let done = status(guard.status()) as usize;
        seen[done] += 1;
        corrected += usize::from(made.position != T::ZERO || made.command != T::ZERO);
    }
    if !course.strict {
        return Ok(bytes);
    }
    // Nothing would be proved by cycles in which nothing happens.
    let [off, on, no_number, position, effort, surprise] = seen;
    let all = [off, on, no_number + surprise, position + effort + surprise];
    if all.contains(&0) || 2 * corrected < samples.len() {
        return Err(format!("cycles that prove little: {seen:?}, {corrected} corrected").into());
    }
    Ok(bytes)
}

fn push<T: Scalar>(bytes: &mut Vec<u8>, value: T) {
    if T::EPSILON.to_f64() > 1e-10 {
        bytes.extend((value.to_f64() as f32).to_le_bytes());
    } else {
        bytes.extend(value.to_f64().to_le_bytes());
    }
}

fn status(status: Status) -> u32 {
    match status {
        Status::Off => 0,
        Status::On => 1,
        Status::Tripped(Trip::NotFinite) => 2,
        Status::Tripped(Trip::Position) => 3,
        Status::Tripped(Trip::Effort) => 4,
        Status::Tripped(Trip::Surprise) => 5,
    }
}

/// What the program said of a comparison.
#[derive(Clone, Copy, Debug)]
pub struct Compared {
    /// Cycles compared, and those in which both outputs have the bits of Rust's.
    pub cycles: usize,
    pub equal: usize,
    /// Greatest deviation of an output, over its value.
    pub worst: f64,
    /// Cycles with another status.
    pub statuses: usize,
    /// `sizeof` the state.
    pub state: usize,
    /// Time of a step, ns.
    pub time: f64,
}

/// The compilers of this machine among gcc and clang.
pub fn compilers() -> Vec<&'static str> {
    let there = |name: &&str| Command::new(name).arg("--version").output().is_ok();
    ["gcc", "clang"].into_iter().filter(there).collect()
}

/// Compiles a program of a case with warnings as errors, and runs it: the numbers that it prints.
fn numbers(
    folder: &Path,
    compiler: &str,
    name: &str,
    program: &str,
    flags: &[&str],
) -> Outcome<Vec<f64>> {
    let made = folder.join(format!("{program}-{compiler}"));
    let compiled = Command::new(compiler)
        .args([
            "-std=c99",
            "-O2",
            "-Wall",
            "-Wextra",
            "-Wpedantic",
            "-Wfloat-equal",
            "-Werror",
        ])
        .args(flags)
        .arg(folder.join(format!("{name}.c")))
        .arg(folder.join(format!("{program}.c")))
        .arg("-o")
        .arg(&made)
        .arg("-lm")
        .output()?;
    if !compiled.status.success() {
        return Err(String::from_utf8_lossy(&compiled.stderr).into());
    }
    let run = Command::new(&made).arg(folder.join("cases.bin")).output()?;
    let said = String::from_utf8_lossy(&run.stdout).into_owned();
    let words = said.split_whitespace();
    Ok(words.filter_map(|w| w.parse().ok()).collect())
}

/// Bytes of the stack that the steps of a case take at most, painted.
pub fn stack(folder: &Path, compiler: &str, name: &str) -> Outcome<usize> {
    match numbers(folder, compiler, name, "stack", &[])?[..] {
        [bytes, _] => Ok(bytes as usize),
        ref said => Err(format!("{name}: {said:?}").into()),
    }
}

/// Compiles a case with warnings as errors, and runs it.
pub fn compare(folder: &Path, compiler: &str, name: &str, flags: &[&str]) -> Outcome<Compared> {
    let said = numbers(folder, compiler, name, "check", flags)?;
    let [cycles, equal, worst, statuses, state, time] = said[..] else {
        return Err(format!("{name}: {said:?}").into());
    };
    Ok(Compared {
        cycles: cycles as usize,
        equal: equal as usize,
        worst,
        statuses: statuses as usize,
        state: state as usize,
        time,
    })
}
