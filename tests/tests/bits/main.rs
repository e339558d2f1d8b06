//! One image, bit for bit, whatever the machine does (promise 1) and at whatever scale the scene is built (promise 3).

mod accel;
mod adaptive;
mod frame;
mod glints;
mod hidden;
mod photons;
mod rays;
mod samples;
mod shapes;
mod work;
