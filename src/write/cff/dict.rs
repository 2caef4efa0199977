//! DICT and INDEX, the two containers of a CFF table.

use super::super::WriteError;
use super::super::numbers::count;

/// Operands and operators, each operand list before its operator.
#[derive(Debug, Clone, Default)]
pub(super) struct Dict(pub(super) Vec<u8>);

impl Dict {
    fn operator(&mut self, operator: u16) {
        let [escape, code] = operator.to_be_bytes();
        if escape != 0 {
            self.0.push(escape);
        }
        self.0.push(code);
    }

    /// One whole number.
    pub(super) fn integer(&mut self, operator: u16, value: i32) {
        integer(&mut self.0, value);
        self.operator(operator);
    }

    /// One whole number, left out where it is what readers assume.
    pub(super) fn integer_unless(&mut self, operator: u16, value: i32, assumed: i32) {
        if value != assumed {
            self.integer(operator, value);
        }
    }

    /// Numbers, each as short as it can be.
    pub(super) fn numbers(&mut self, operator: u16, values: &[f64]) {
        for &v in values {
            match whole(v) {
                Some(n) => integer(&mut self.0, n),
                None => real(&mut self.0, v),
            }
        }
        self.operator(operator);
    }

    /// Offsets or lengths inside the table.
    pub(super) fn offsets(&mut self, operator: u16, values: &[usize]) -> Result<(), WriteError> {
        for &v in values {
            let v = i32::try_from(v).map_err(|_| WriteError::table("CFF ", "it exceeds 2 GiB"))?;
            integer(&mut self.0, v);
        }
        self.operator(operator);
        Ok(())
    }
}

/// The number as an integer where it is one.
#[expect(
    clippy::cast_possible_truncation,
    reason = "the range is checked, the fraction is zero"
)]
fn whole(v: f64) -> Option<i32> {
    (v.fract().abs() <= 0.0 && v.abs() < 2e9).then_some(v as i32)
}

/// An integer of a DICT: 1, 2, 3 or 5 bytes.
fn integer(out: &mut Vec<u8>, v: i32) {
    if super::charstring::short_integer(out, v) {
        return;
    }
    out.push(29);
    out.extend(v.to_be_bytes());
}

/// A decimal number, two digits a byte.
fn real(out: &mut Vec<u8>, v: f64) {
    let text = format!("{v:e}");
    let (digits, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let mut nibbles: Vec<u8> = digits.bytes().filter_map(nibble).collect();
    if exponent != "0" {
        nibbles.push(if exponent.starts_with('-') { 0xC } else { 0xB });
        nibbles.extend(exponent.trim_start_matches('-').bytes().filter_map(nibble));
    }
    nibbles.push(0xF);
    if nibbles.len() % 2 == 1 {
        nibbles.push(0xF);
    }
    out.push(30);
    out.extend(
        nibbles
            .chunks_exact(2)
            .map(|n| n.iter().fold(0, |b, n| b << 4 | n)),
    );
}

const fn nibble(c: u8) -> Option<u8> {
    match c {
        b'0'..=b'9' => Some(c - b'0'),
        b'.' => Some(0xA),
        b'-' => Some(0xE),
        _ => None,
    }
}

/// An INDEX of these objects.
pub(super) fn index(objects: &[Vec<u8>]) -> Result<Vec<u8>, WriteError> {
    let mut out = count(objects.len(), "the number of objects in a CFF index")?
        .to_be_bytes()
        .to_vec();
    if objects.is_empty() {
        return Ok(out);
    }
    let total: usize = 1 + objects.iter().map(Vec::len).sum::<usize>();
    let total = u32::try_from(total).map_err(|_| WriteError::table("CFF ", "it exceeds 4 GiB"))?;
    let skip = total
        .to_be_bytes()
        .iter()
        .take_while(|b| **b == 0)
        .count()
        .min(3);
    out.extend((4 - skip).to_be_bytes().last());
    let mut at: u32 = 1;
    let offset = |out: &mut Vec<u8>, at: u32| out.extend(at.to_be_bytes().iter().skip(skip));
    offset(&mut out, at);
    for object in objects {
        at = at.saturating_add(u32::try_from(object.len()).unwrap_or(u32::MAX));
        offset(&mut out, at);
    }
    out.extend(objects.concat());
    Ok(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_as_the_specification_prints_them() {
        // Technical Note 5176, table 4 and the example of section 4
        for (value, bytes) in [
            (0, vec![0x8b]),
            (100, vec![0xef]),
            (-100, vec![0x27]),
            (1000, vec![0xfa, 0x7c]),
            (-1000, vec![0xfe, 0x7c]),
            (10000, vec![0x1c, 0x27, 0x10]),
            (-10000, vec![0x1c, 0xd8, 0xf0]),
            (100_000, vec![0x1d, 0x00, 0x01, 0x86, 0xa0]),
            (-100_000, vec![0x1d, 0xff, 0xfe, 0x79, 0x60]),
        ] {
            let mut out = Vec::new();
            integer(&mut out, value);
            assert_eq!(out, bytes, "{value}");
        }
        let mut out = Vec::new();
        real(&mut out, -2.25);
        assert_eq!(out, [0x1e, 0xe2, 0xa2, 0x5f]);
        out.clear();
        real(&mut out, 0.140_541E-3);
        assert_eq!(out, [0x1e, 0x1a, 0x40, 0x54, 0x1c, 0x4f]);
    }

    #[test]
    fn an_index() {
        assert_eq!(index(&[]).unwrap(), [0, 0]);
        let two = index(&[b"ab".to_vec(), b"c".to_vec()]).unwrap();
        assert_eq!(two, [0, 2, 1, 1, 3, 4, b'a', b'b', b'c']);
        let long = index(&[vec![7; 300]]).unwrap();
        assert_eq!(long[..7], [0, 1, 2, 0, 1, 1, 45]);
    }
}
