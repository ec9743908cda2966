//! Random damage to a text: what a slip of the pen, a broken download or malice would do.

/// Numbers and words that readers stumble over.
const NASTY: [&str; 26] = [
    "0",
    "-0",
    "-1",
    "1e308",
    "-1e308",
    "1e-308",
    "nan",
    "inf",
    "99999999999999999999",
    "0.0000001",
    "",
    " ",
    "\n",
    "M",
    "Z",
    "z m 0 0",
    "L",
    "A 0 0 0 1 1 5 5",
    "C",
    "\u{0}",
    "é",
    "<",
    ">",
    "\"",
    "POLYLINE",
    "SEQEND",
];

/// A source of damage: the same seed gives the same damage.
pub(crate) struct Damage {
    state: u64,
}

impl Damage {
    pub(crate) fn new(seed: u64) -> Self {
        Self { state: seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ 0x2545_f491_4f6c_dd1d }
    }

    /// The next of a row of random numbers below `most` (xorshift64*).
    fn below(&mut self, most: usize) -> usize {
        self.state ^= self.state >> 12;
        self.state ^= self.state << 25;
        self.state ^= self.state >> 27;
        (self.state.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 33) as usize % most.max(1)
    }

    /// `text` with one to six faults.
    pub(crate) fn of(&mut self, text: &str) -> String {
        let mut chars: Vec<char> = text.chars().collect();
        for _ in 0..=self.below(6) {
            self.fault(&mut chars);
        }
        chars.into_iter().collect()
    }

    fn fault(&mut self, chars: &mut Vec<char>) {
        let from = self.below(chars.len());
        let to = (from + self.below(40)).min(chars.len());
        match self.below(7) {
            0 => drop(chars.drain(from..to)),
            1 => {
                let copy: Vec<char> = chars[from..to].to_vec();
                let at = self.below(chars.len() + 1);
                chars.splice(at..at, copy);
            }
            2 => chars.truncate(from),
            3 => self.number(chars, from),
            4 => {
                let word = NASTY[self.below(NASTY.len())];
                chars.splice(from..to, word.chars());
            }
            5 => {
                let other = self.below(chars.len());
                if from < chars.len() {
                    chars.swap(from, other);
                }
            }
            _ => {
                let line: Vec<char> = chars[from..to].to_vec();
                for _ in 0..self.below(50) {
                    chars.splice(from..from, line.iter().copied());
                }
            }
        }
        if chars.is_empty() {
            chars.push(' ');
        }
    }

    /// Puts something else in the place of the next number.
    fn number(&mut self, chars: &mut Vec<char>, from: usize) {
        let is_digit = |c: &char| c.is_ascii_digit() || *c == '.' || *c == '-';
        let Some(start) = (from..chars.len()).find(|&k| is_digit(&chars[k])) else { return };
        let end = (start..chars.len()).find(|&k| !is_digit(&chars[k])).unwrap_or(chars.len());
        let word = NASTY[self.below(NASTY.len())];
        chars.splice(start..end, word.chars());
    }
}
