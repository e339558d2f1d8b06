//! How surfaces scatter light. The kernels that do it for whole streams are the stages of [`stream`](crate::stream);
//! here are the functions of optics that they share.

pub mod fresnel;
