//! Mutations of text: bits of the seeds and words of the format, moved, repeated, lost and broken.

/// What a fuzzer starts from.
pub(crate) struct Source<'a> {
    /// Texts that are right.
    pub(crate) seeds: &'a [&'a str],
    /// Words that mean something.
    pub(crate) words: &'a [&'a str],
}

/// A small generator (xorshift, Marsaglia 2003): the same inputs on every machine.
pub(crate) struct Mutator(u64);

/// Texts are cut to this many characters, or to twice their seed's: what is slow at a few kilobytes is told apart from
/// what is merely long.
const LONGEST: usize = 8_000;

impl Mutator {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1)
    }

    fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    fn below(&mut self, n: usize) -> usize {
        (self.next() % n.max(1) as u64) as usize
    }

    fn pick<'a>(&mut self, from: &[&'a str]) -> &'a str {
        from[self.below(from.len())]
    }

    /// A seed with one to eight things wrong.
    pub(crate) fn mutated(&mut self, source: &Source) -> String {
        let mut text: Vec<char> = self.pick(source.seeds).chars().collect();
        let longest = LONGEST.max(2 * text.len());
        for _ in 0..=self.below(8) {
            match self.below(7) {
                0 => self.lose(&mut text),
                1 => self.repeat(&mut text),
                2 => self.insert_word(&mut text, source),
                3 => self.change_number(&mut text),
                4 => self.swap_lines(&mut text),
                5 => self.change_character(&mut text),
                _ => self.splice(&mut text, source),
            }
        }
        text.truncate(longest);
        text.into_iter().collect()
    }

    /// A seed with one to eight bytes, stretches or numbers of it changed, lost or repeated.
    pub(crate) fn mutated_bytes(&mut self, seeds: &[&[u8]]) -> Vec<u8> {
        let mut bytes = seeds[self.below(seeds.len())].to_vec();
        for _ in 0..=self.below(8) {
            let range = self.range(bytes.len(), 24);
            match self.below(5) {
                0 => drop(bytes.drain(range)),
                1 => {
                    let piece = bytes[range.clone()].to_vec();
                    bytes.splice(range.start..range.start, piece.repeat(1 + self.below(20)));
                }
                2 => bytes.splice(range.start..range.start, [0xff; 4]).for_each(drop),
                3 => bytes[range].fill(0),
                _ => bytes.iter_mut().skip(range.start).take(1).for_each(|byte| *byte ^= 1 << (self.next() % 8)),
            }
            if bytes.is_empty() {
                break;
            }
        }
        bytes
    }

    fn range(&mut self, length: usize, most: usize) -> std::ops::Range<usize> {
        let from = self.below(length);
        from..(from + 1 + self.below(most)).min(length)
    }

    fn lose(&mut self, text: &mut Vec<char>) {
        let range = self.range(text.len(), 40);
        text.drain(range);
    }

    fn repeat(&mut self, text: &mut Vec<char>) {
        let range = self.range(text.len(), 200);
        let piece: Vec<char> = text[range].to_vec();
        let times = 1 + self.below(20);
        let at = self.below(text.len());
        text.splice(at..at, piece.repeat(times));
    }

    fn insert_word(&mut self, text: &mut Vec<char>, source: &Source) {
        let word = self.pick(source.words);
        let at = self.below(text.len());
        text.splice(at..at, word.chars());
    }

    fn change_number(&mut self, text: &mut Vec<char>) {
        let digits: Vec<usize> = (0..text.len()).filter(|&i| text[i].is_ascii_digit()).collect();
        if digits.is_empty() {
            return;
        }
        let at = digits[self.below(digits.len())];
        let new = self.pick(&["0", "-1", "1e9", "0.0001", "9999999", "1e308", ".", "--1", "7"]);
        text.splice(at..=at, new.chars());
    }

    fn swap_lines(&mut self, text: &mut Vec<char>) {
        let whole: String = text.iter().collect();
        let mut lines: Vec<&str> = whole.split('\n').collect();
        let (a, b) = (self.below(lines.len()), self.below(lines.len()));
        lines.swap(a, b);
        *text = lines.join("\n").chars().collect();
    }

    fn change_character(&mut self, text: &mut [char]) {
        if text.is_empty() {
            return;
        }
        let at = self.below(text.len());
        let signs =
            [':', ',', '[', ']', '{', '}', '"', '\'', '\n', ' ', '#', '&', '*', '-', '%', '@', '.', '\0', '\u{202e}'];
        text[at] = signs[self.below(signs.len())];
    }

    /// A stretch of a seed somewhere else.
    fn splice(&mut self, text: &mut Vec<char>, source: &Source) {
        let other: Vec<char> = self.pick(source.seeds).chars().collect();
        let from = self.range(other.len(), 300);
        let range = self.range(text.len(), 300);
        text.splice(range, other[from].iter().copied());
    }
}
