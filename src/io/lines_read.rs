//! Reads lines in space, along which a surface is cut: an OBJ file with `l` elements, or points, three numbers a line,
//! with an empty line between two lines. Brackets, commas and the dashes of YAML lists are passed over.

use std::path::Path;

use super::obj_read::{ObjError, obj_text};
use crate::geometry::Vec3;

/// Reads a file; every line has two points or more.
///
/// # Errors
/// [`ObjError::Line`] for a line that is wrong, [`ObjError::NoLines`] where there is no line.
pub fn read_lines(path: &Path) -> Result<Vec<Vec<Vec3>>, ObjError> {
    let (text, file) = (obj_text(path)?, path.display().to_string());
    let is_obj = text.lines().any(|line| line.starts_with("v ") || line.starts_with("l "));
    let read = if is_obj { of_obj(&text) } else { of_points(&text) };
    let lines = read.map_err(|(line, why)| ObjError::Line { file: file.clone(), line, why })?;
    if lines.is_empty() { Err(ObjError::NoLines { file }) } else { Ok(lines) }
}

/// A line of the file, from 1, and its fault.
type Fault = (usize, String);

fn numbers(words: &str) -> Option<Vec3> {
    let numbers: Result<Vec<f64>, _> = words.split_whitespace().take(3).map(str::parse).collect();
    numbers.ok().filter(|n| n.len() == 3 && n.iter().all(|x| x.is_finite())).map(|n| Vec3::new(n[0], n[1], n[2]))
}

/// The `l` elements of an OBJ file. Ends that two of them share make one line of them where one ends and the next
/// begins, as programs write a polyline side by side.
fn of_obj(text: &str) -> Result<Vec<Vec<Vec3>>, Fault> {
    let mut places = Vec::new();
    let mut lines: Vec<Vec<usize>> = Vec::new();
    for (line, text) in (1..).zip(text.lines()) {
        if let Some(rest) = text.strip_prefix("v ") {
            places.push(numbers(rest).ok_or_else(|| (line, "three numbers are expected after 'v'".to_owned()))?);
        } else if let Some(rest) = text.strip_prefix("l ") {
            let index = |word: &str| {
                let number: i64 = word.split('/').next().and_then(|w| w.parse().ok())?;
                let index = if number < 0 { places.len() as i64 + number } else { number - 1 };
                usize::try_from(index).ok().filter(|k| *k < places.len())
            };
            let wrong = |word: &str| (line, format!("there is no vertex '{word}' above; there are {}", places.len()));
            let run: Vec<usize> =
                rest.split_whitespace().map(|w| index(w).ok_or_else(|| wrong(w))).collect::<Result<_, _>>()?;
            match (lines.last_mut(), run.split_first()) {
                (Some(last), Some((first, rest))) if last.last() == Some(first) => last.extend(rest),
                (_, Some(_)) => lines.push(run),
                // An element without vertices is no line.
                (_, None) => {}
            }
        }
    }
    let lines = lines.into_iter().filter(|run| run.len() > 1);
    Ok(lines.map(|run| run.into_iter().map(|k| places[k]).collect()).collect())
}

/// Lines of points.
fn of_points(text: &str) -> Result<Vec<Vec<Vec3>>, Fault> {
    let mut lines = vec![Vec::new()];
    for (line, text) in (1..).zip(text.lines()) {
        let text = text.split('#').next().unwrap_or_default();
        let bare: String = text.chars().map(|c| if "[],;".contains(c) { ' ' } else { c }).collect();
        let bullets = bare.split_whitespace().take_while(|word| *word == "-").count();
        let words = bare.split_whitespace().skip(bullets).collect::<Vec<_>>().join(" ");
        // A list within a list begins anew.
        if words.is_empty() || bullets > 1 {
            lines.push(Vec::new());
        }
        if !words.is_empty() {
            let wrong = || (line, format!("three numbers x y z are expected, not '{}'", words.trim()));
            let place = if words.split_whitespace().count() == 3 { numbers(&words) } else { None };
            lines.last_mut().unwrap_or(&mut Vec::new()).push(place.ok_or_else(wrong)?);
        }
    }
    lines.retain(|line| line.len() > 1);
    Ok(lines)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_and_elements_are_lines() {
        let two = vec![vec![Vec3::x(), Vec3::y(), Vec3::z()], vec![Vec3::zeros(), Vec3::y()]];
        let obj = "v 1 0 0\nv 0 1 0\nv 0 0 1\nv 0 0 0\nl 1 2\nl 2 3\nl 4 2\n";
        assert_eq!(of_obj(obj), Ok(two.clone()));
        assert_eq!(of_obj(&obj.replace("l 1 2", "l \nl \nl 1 2")), Ok(two.clone()));
        assert_eq!(of_points("1 0 0\n0, 1, 0\n0 0 1\n\n0 0 0 # here\n0 1 0\n"), Ok(two.clone()));
        assert_eq!(of_points("- - [1, 0, 0]\n  - [0, 1, 0]\n  - [0, 0, 1]\n- - [0, 0, 0]\n  - [0, 1, 0]\n"), Ok(two));
        assert_eq!(of_points("1 0 0\n1 2\n").map_err(|fault| fault.0), Err(2));
        assert_eq!(of_obj("v 1 0 0\nl 1 2\n").map_err(|fault| fault.0), Err(2));
    }
}
