//! Named parameters of the functions that evaluate shapes and modifiers. A table of members becomes a struct by
//! [`eval_params!`](crate::eval_params), with its places in rows of four numbers. The `wgsl` crate writes the struct of
//! the same name for the GPU, and its reading, from the same [`ParamLayout`].

/// Most members of the parameters of one function.
pub const MAX_MEMBERS: usize = 16;
/// Most numbers that they take: ten rows.
const MAX_FLOATS: usize = 40;
/// Numbers in a row.
const ROW: usize = 4;

/// The type of a member.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MemberType {
    /// A number.
    Number,
    /// A whole number from 0 on, exact in f32.
    Count,
    /// Two numbers.
    Pair,
    /// Three numbers.
    Vector,
    /// Members of its own.
    Struct(&'static ParamLayout),
}

impl MemberType {
    /// Numbers that it takes; they lie in one row.
    pub const fn floats(self) -> usize {
        match self {
            Self::Number | Self::Count => 1,
            Self::Pair => 2,
            Self::Vector => 3,
            Self::Struct(layout) => layout.floats(),
        }
    }
}

/// A member of parameters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct EvalMember {
    /// Its name, in Rust and in WGSL.
    pub name: &'static str,
    /// Its type.
    pub ty: MemberType,
}

/// Names and places of parameters in rows of four numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ParamLayout {
    /// The name of the struct, in Rust and in WGSL.
    pub name: &'static str,
    /// Its members, in order.
    pub members: &'static [EvalMember],
}

impl ParamLayout {
    /// The place of each member, in numbers from the start of the first row: the first free one from which it fits into
    /// its row.
    pub const fn places(&self) -> [usize; MAX_MEMBERS] {
        let (mut places, mut used) = ([0; MAX_MEMBERS], [false; MAX_FLOATS]);
        let mut i = 0;
        while i < self.members.len() {
            let floats = self.members[i].ty.floats();
            let mut at = 0;
            while !is_free(&used, at, floats) {
                at += 1;
            }
            places[i] = at;
            let end = at + floats;
            while at < end {
                used[at] = true;
                at += 1;
            }
            i += 1;
        }
        places
    }

    /// Numbers from the first member to the end of the last.
    pub const fn floats(&self) -> usize {
        let (places, mut end, mut i) = (self.places(), 0, 0);
        while i < self.members.len() {
            let after = places[i] + self.members[i].ty.floats();
            end = if after > end { after } else { end };
            i += 1;
        }
        end
    }

    /// Rows of four numbers.
    pub const fn rows(&self) -> usize {
        self.floats().div_ceil(ROW)
    }
}

/// Whether numbers from a place on are free and in one row.
const fn is_free(used: &[bool; MAX_FLOATS], at: usize, floats: usize) -> bool {
    let mut i = 0;
    while i < floats {
        if used[at + i] {
            return false;
        }
        i += 1;
    }
    at % ROW + floats <= ROW
}

/// The type of a member in Rust.
pub trait EvalValue: Copy {
    /// Its type in the layout.
    const TYPE: MemberType;
    /// Reads it from its numbers.
    fn read_value(number: &impl Fn(usize) -> f64) -> Self;
    /// Calls `put` with the index of each of its numbers, and the number.
    fn write_value(self, put: &mut impl FnMut(usize, f64));
}

impl EvalValue for f64 {
    const TYPE: MemberType = MemberType::Number;
    fn read_value(number: &impl Fn(usize) -> f64) -> Self {
        number(0)
    }
    fn write_value(self, put: &mut impl FnMut(usize, f64)) {
        put(0, self);
    }
}

impl EvalValue for u32 {
    const TYPE: MemberType = MemberType::Count;
    fn read_value(number: &impl Fn(usize) -> f64) -> Self {
        number(0) as Self
    }
    fn write_value(self, put: &mut impl FnMut(usize, f64)) {
        put(0, f64::from(self));
    }
}

/// Implements the trait for several numbers.
macro_rules! numbers {
    ($($count:literal = $type:ident;)+) => { $(
        impl EvalValue for [f64; $count] {
            const TYPE: MemberType = MemberType::$type;
            fn read_value(number: &impl Fn(usize) -> f64) -> Self {
                std::array::from_fn(number)
            }
            fn write_value(self, put: &mut impl FnMut(usize, f64)) {
                self.into_iter().enumerate().for_each(|(i, number)| put(i, number));
            }
        }
    )+ };
}
numbers! {
    2 = Pair;
    3 = Vector;
}

/// A struct of [`eval_params!`](crate::eval_params).
pub trait EvalParams: Copy {
    /// Its names and places.
    const LAYOUT: ParamLayout;
    /// Reads it; `number` returns the number at a place, counted over the rows.
    fn read(number: impl Fn(usize) -> f64) -> Self;
    /// Calls `put` with the place of each number, and the number.
    fn write(&self, put: impl FnMut(usize, f64));

    /// Its rows; unused numbers are 0.
    fn to_rows(&self) -> Vec<[f64; 4]> {
        let mut rows = vec![[0.0; ROW]; Self::LAYOUT.rows()];
        self.write(|at, number| rows[at / ROW][at % ROW] = number);
        rows
    }
}

/// Defines a struct of parameters by its members: `/// What. Name { /// What. member: type, }`.
#[macro_export]
macro_rules! eval_params {
    ($(#[doc = $doc:literal])+ $name:ident { $( $(#[doc = $help:literal])+ $member:ident: $type:ty, )* }) => {
        $(#[doc = $doc])+
        #[repr(C)]
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub struct $name { $( $(#[doc = $help])+ pub $member: $type, )* }

        impl $crate::EvalParams for $name {
            const LAYOUT: $crate::ParamLayout = $crate::ParamLayout {
                name: stringify!($name),
                members: &[ $( $crate::EvalMember {
                    name: stringify!($member),
                    ty: <$type as $crate::EvalValue>::TYPE,
                }, )* ],
            };

            #[allow(unused_mut, unused_variables, reason = "some have no members")]
            fn read(number: impl Fn(usize) -> f64) -> Self {
                const PLACES: [usize; $crate::MAX_MEMBERS] = <$name as $crate::EvalParams>::LAYOUT.places();
                let mut places = PLACES.into_iter();
                let mut next = || places.next().unwrap_or_default();
                Self { $( $member: {
                    let at = next();
                    <$type as $crate::EvalValue>::read_value(&|i: usize| number(at + i))
                }, )* }
            }

            #[allow(unused_mut, unused_variables, reason = "some have no members")]
            fn write(&self, mut put: impl FnMut(usize, f64)) {
                const PLACES: [usize; $crate::MAX_MEMBERS] = <$name as $crate::EvalParams>::LAYOUT.places();
                let mut places = PLACES.into_iter();
                $(
                    let at = places.next().unwrap_or_default();
                    <$type as $crate::EvalValue>::write_value(self.$member, &mut |i: usize, v: f64| put(at + i, v));
                )*
            }
        }
    };
}

/// A struct of parameters as the member of another.
macro_rules! eval_value {
    ($name:ident) => {
        impl EvalValue for $name {
            const TYPE: MemberType = MemberType::Struct(&<$name as EvalParams>::LAYOUT);
            fn read_value(number: &impl Fn(usize) -> f64) -> Self {
                Self::read(number)
            }
            fn write_value(self, put: &mut impl FnMut(usize, f64)) {
                self.write(put);
            }
        }
    };
}

eval_params! {
    /// An angle: the GPU's own functions are not exact enough to compute these.
    SineCosine {
        /// Its sine.
        sine: f64,
        /// Its cosine.
        cosine: f64,
    }
}
eval_value!(SineCosine);

eval_params! {
    /// The sides of a regular polygon.
    PolygonSides {
        /// Their number.
        count: f64,
        /// The cosine of half the angle of one side.
        cosine: f64,
        /// The sine of half the angle of one side.
        sine: f64,
    }
}
eval_value!(PolygonSides);

#[cfg(test)]
mod tests {
    use super::*;

    eval_params! {
        /// Members that do not fit into their rows in order.
        Crossing {
            /// Takes places 0 and 1.
            pair: [f64; 2],
            /// Begins a row.
            vector: [f64; 3],
            /// Fills the first row.
            angle: SineCosine,
            /// Fills the second row.
            count: u32,
            /// Begins the third row.
            last: f64,
        }
    }

    #[test]
    fn a_member_takes_the_first_gap_in_one_row() {
        let layout = Crossing::LAYOUT;
        assert_eq!(layout.places()[..5], [0, 4, 2, 7, 8]);
        assert_eq!((layout.floats(), layout.rows()), (9, 3));
        let angle = SineCosine { sine: 6.0, cosine: 7.0 };
        let params = Crossing { pair: [1.0, 2.0], vector: [3.0, 4.0, 5.0], angle, count: 8, last: 9.0 };
        let rows = params.to_rows();
        assert_eq!(rows, [[1.0, 2.0, 6.0, 7.0], [3.0, 4.0, 5.0, 8.0], [9.0, 0.0, 0.0, 0.0]]);
        assert_eq!(Crossing::read(|i| rows[i / 4][i % 4]), params);
    }
}
