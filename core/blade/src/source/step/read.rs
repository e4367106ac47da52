//! B-spline surfaces of a STEP file.

use super::part21::{Broken, Exchange, Value, record};
use coolinggen_nurbs::{Homogeneous, Knots, NurbsError, Surface};
use glam::DVec3;

/// A surface with the names of the faces that lie on it.
#[derive(Clone, Debug)]
pub(super) struct Patch {
    /// Number of its instance in the file.
    pub(super) id: u64,
    pub(super) names: Vec<String>,
    pub(super) net: Surface<Homogeneous<DVec3>>,
    pub(super) rational: bool,
}

/// Why there are no surfaces.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum ReadError {
    Broken(Broken),
    /// A surface that is not valid.
    Surface {
        id: u64,
        error: NurbsError,
    },
}

impl From<Broken> for ReadError {
    fn from(broken: Broken) -> Self {
        Self::Broken(broken)
    }
}

/// More surfaces than this are not a blade's.
pub(super) const MOST: usize = 2_000;

/// All B-spline surfaces, in mm.
pub(super) fn patches(file: &Exchange<'_>) -> Result<Vec<Patch>, ReadError> {
    let scale = millimetres(file)?;
    let mut faces: Vec<(u64, String)> = Vec::new();
    for (_, records) in file.with_word("FACE")? {
        for keyword in ["ADVANCED_FACE", "FACE_SURFACE"] {
            if let Some([Value::Text(name), _, Value::Reference(surface), ..]) = record(&records, keyword) {
                faces.push((*surface, name.clone()));
            }
        }
    }
    let mut patches = Vec::new();
    for (id, records) in file.with_word("B_SPLINE_SURFACE_WITH_KNOTS")? {
        if patches.len() >= MOST {
            break;
        }
        let (net, rational) = surface(file, id, &records, scale)?;
        let names = faces.iter().filter(|(s, _)| *s == id).map(|(_, name)| name.clone()).collect();
        patches.push(Patch { id, names, net, rational });
    }
    Ok(patches)
}

fn surface(
    file: &Exchange<'_>,
    id: u64,
    records: &[Value],
    scale: f64,
) -> Result<(Surface<Homogeneous<DVec3>>, bool), ReadError> {
    let malformed = || ReadError::Broken(Broken::Malformed { id });
    let with_knots = record(records, "B_SPLINE_SURFACE_WITH_KNOTS").ok_or_else(malformed)?;
    // A simple instance has all parameters in one record, after the name; a complex one has them in two.
    let (shape, knots) = match record(records, "B_SPLINE_SURFACE") {
        Some(shape) => (shape, with_knots),
        None if with_knots.len() >= 12 => (&with_knots[1..8], &with_knots[8..]),
        None => return Err(malformed()),
    };
    let ([Value::Number(p), Value::Number(q), Value::List(rows), ..], [mu, mv, ku, kv, ..]) = (shape, knots)
    else {
        return Err(malformed());
    };
    let knots = |degree: f64, multiplicities: &Value, values: &Value| -> Result<Knots, ReadError> {
        let (Some(m), Some(k)) = (numbers(multiplicities), numbers(values)) else { return Err(malformed()) };
        if m.len() != k.len()
            || m.iter().any(|m| !(1.0..=64.0).contains(m))
            || !(1.0..=64.0).contains(&degree)
        {
            return Err(malformed());
        }
        let all = k.iter().zip(m).flat_map(|(&k, m)| std::iter::repeat_n(k, m as usize)).collect();
        Knots::new(degree as usize, all).map_err(|error| ReadError::Surface { id, error })
    };
    let (knots_u, knots_v) = (knots(*p, mu, ku)?, knots(*q, mv, kv)?);
    let weights = match record(records, "RATIONAL_B_SPLINE_SURFACE") {
        Some([Value::List(rows)]) => {
            let rows: Option<Vec<Vec<f64>>> = rows.iter().map(numbers).collect();
            Some(rows.ok_or_else(malformed)?.concat())
        }
        Some(_) => return Err(malformed()),
        None => None,
    };
    let mut points = Vec::new();
    for row in rows {
        let Value::List(row) = row else { return Err(malformed()) };
        for reference in row {
            let Value::Reference(point) = reference else { return Err(malformed()) };
            points.push(cartesian(file, *point)? * scale);
        }
    }
    let improper = |w: &Vec<f64>| w.len() != points.len() || w.iter().any(|w| !(*w > 0.0 && w.is_finite()));
    if weights.as_ref().is_some_and(improper) {
        return Err(malformed());
    }
    let weight = |i: usize| weights.as_ref().map_or(1.0, |w| w[i]);
    let rational = weights.as_ref().is_some_and(|w| w.iter().any(|x| *x != w[0]));
    let points =
        points.iter().enumerate().map(|(i, &p)| Homogeneous::new(p, if rational { weight(i) } else { 1.0 }));
    let net = Surface::new(knots_u, knots_v, points.collect());
    Ok((net.map_err(|error| ReadError::Surface { id, error })?, rational))
}

fn cartesian(file: &Exchange<'_>, id: u64) -> Result<DVec3, ReadError> {
    let records = file.records(id)?;
    match record(&records, "CARTESIAN_POINT") {
        Some([_, coordinates]) => match numbers(coordinates).as_deref() {
            Some(&[x, y, z]) => Ok(DVec3::new(x, y, z)),
            _ => Err(Broken::Malformed { id }.into()),
        },
        _ => Err(Broken::Malformed { id }.into()),
    }
}

fn numbers(value: &Value) -> Option<Vec<f64>> {
    let Value::List(values) = value else { return None };
    values.iter().map(|v| if let Value::Number(x) = v { Some(*x) } else { None }).collect()
}

/// Millimetres in the file's unit of length: that of the first global unit context, else 1.
fn millimetres(file: &Exchange<'_>) -> Result<f64, ReadError> {
    for (_, context) in file.with_word("GLOBAL_UNIT_ASSIGNED_CONTEXT")? {
        let Some([Value::List(units)]) = record(&context, "GLOBAL_UNIT_ASSIGNED_CONTEXT") else { continue };
        for unit in units {
            let Value::Reference(unit) = unit else { continue };
            if let Some(scale) = length_unit(file, *unit, 0)? {
                return Ok(scale);
            }
        }
    }
    Ok(1.0)
}

/// Millimetres in a unit, if it is one of length.
fn length_unit(file: &Exchange<'_>, id: u64, depth: usize) -> Result<Option<f64>, ReadError> {
    let records = file.records(id)?;
    if record(&records, "LENGTH_UNIT").is_none() || depth > 4 {
        return Ok(None);
    }
    if let Some([.., Value::Word(prefix), Value::Word(name)]) = record(&records, "SI_UNIT") {
        let metres = match prefix.as_str() {
            "" => 1.0,
            "MILLI" => 1e-3,
            "CENTI" => 1e-2,
            "DECI" => 1e-1,
            "MICRO" => 1e-6,
            "KILO" => 1e3,
            _ => return Ok(None),
        };
        return Ok((name == "METRE").then_some(metres * 1e3));
    }
    let Some([_, Value::Reference(factor)]) = record(&records, "CONVERSION_BASED_UNIT") else {
        return Ok(None);
    };
    // The factor is a measure of another unit of length.
    let measure = file.records(*factor)?;
    let parts = measure.iter().find_map(|r| match r {
        Value::Typed(_, values) => match &values[..] {
            [Value::Typed(_, value), Value::Reference(unit)] => match value[..] {
                [Value::Number(x)] => Some((x, *unit)),
                _ => None,
            },
            _ => None,
        },
        _ => None,
    });
    let Some((value, unit)) = parts else { return Ok(None) };
    Ok(length_unit(file, unit, depth + 1)?.map(|scale| scale * value))
}
