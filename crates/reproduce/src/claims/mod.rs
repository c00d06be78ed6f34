//! One claim a file, and what they share.

mod elastic;
mod f1;
mod f2;
mod f3;
mod f4;
mod f5;
mod f6;
mod f7;
mod f8;
mod f9;
mod prelude;
mod q1;
mod q10;
mod q11;
mod q12;
mod q13;
mod q14;
mod q15;
mod q2;
mod q3;
mod q4;
mod q5;
mod q6;
mod q7;
mod q8;
mod q9;
mod s1;
mod s2;
mod s3;
mod s4;
mod s5;
mod s6;

use crate::claim::Claim;

/// All claims, in the order of the report.
pub const CLAIMS: &[Claim] = &[
    f1::CLAIM,
    f2::CLAIM,
    f3::CLAIM,
    f4::CLAIM,
    f5::CLAIM,
    f6::CLAIM,
    f7::CLAIM,
    f8::CLAIM,
    f9::CLAIM,
    s1::CLAIM,
    s2::CLAIM,
    s3::CLAIM,
    s4::CLAIM,
    s5::CLAIM,
    s6::CLAIM,
    q1::CLAIM,
    q2::CLAIM,
    q3::CLAIM,
    q4::CLAIM,
    q5::CLAIM,
    q6::CLAIM,
    q7::CLAIM,
    q8::CLAIM,
    q9::CLAIM,
    q10::CLAIM,
    q11::CLAIM,
    q12::CLAIM,
    q13::CLAIM,
    q14::CLAIM,
    q15::CLAIM,
];
