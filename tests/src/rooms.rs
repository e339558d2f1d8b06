//! Random closed rooms of unlike scales: a camera close to one of a few casters, whose sizes, like those of the lamps, span
//! several decades.
//!
//! A room is a function of its number. Each is lit so that its middle caster receives about the same irradiance from each
//! lamp, so that no lamp can be ignored.

use core::f64::consts::PI;

use glam::DVec3;
use smalti_core::scene::World;
use smalti_core::scene::world::{Material, Sphere};

use crate::build::{at, camera, closed_box, grey, material, mirror, quad, sphere};
use crate::oracle::Random;

/// Rooms of the study.
pub const ROOMS: u64 = 30;

/// Decades that the sizes of a room's casters and lamps span.
pub fn decades(number: u64) -> i32 {
    match number {
        0..24 => 4,
        24..28 => 5,
        _ => 6,
    }
}

/// The room of this number.
pub fn room(number: u64) -> World {
    let mut random = Random::new(0x0052_6f6f_6d73 + number);
    let half = at(random.between(1.0, 3.0), random.between(1.0, 3.0), random.between(1.0, 2.0));
    let mut world = World::default();
    let walls = material(&mut world, grey(random.between(0.3, 0.8)));
    closed_box(&mut world, at(0.0, 0.0, half.z), half, walls, None);
    let mut room = Room { world, half, least: libm::exp10(-f64::from(decades(number))), random };
    let focus = room.focus();
    room.casters(focus);
    room.lamps(focus);
    room.camera(focus);
    room.world
}

/// The scene file of a room.
pub fn scene_file(world: &World) -> String {
    let camera = &world.cameras[0];
    let fov = camera.fov * 180.0 / PI;
    let mut text = format!(
        "[camera]\neye = {}\nlook_at = {}\nup = {}\nfov = {fov}\n\n[render]\nsize = [64, 64]\nspp = 64\n",
        listed(camera.eye),
        listed(camera.look_at),
        listed(camera.up)
    );
    for (number, material) in world.materials.iter().enumerate() {
        let kind = match material {
            Material::Lambert { albedo } => format!("lambert = {{ albedo = {albedo:?} }}"),
            Material::Mirror { reflectance } => format!("mirror = {{ reflectance = {reflectance:?} }}"),
            Material::Dielectric { ior, .. } => format!("dielectric = {{ ior = {ior} }}"),
        };
        text += &format!("\n[material.m{number}]\n{kind}\n");
    }
    let emits = |radiance: Option<[f64; 3]>| radiance.map_or(String::new(), |x| format!("radiance = {x:?}\n"));
    for polygon in &world.polygons {
        let corners: Vec<String> = polygon.vertices.iter().map(|corner| listed(*corner)).collect();
        let (corners, light) = (corners.join(", "), emits(polygon.radiance));
        text += &format!("\n[[polygon]]\nmaterial = \"m{}\"\nvertices = [{corners}]\n{light}", polygon.material);
    }
    for ball in &world.spheres {
        let (centre, light) = (listed(ball.centre), emits(ball.radiance));
        let Sphere { radius, material, .. } = ball;
        text += &format!("\n[[sphere]]\nmaterial = \"m{material}\"\ncentre = {centre}\nradius = {radius}\n{light}");
    }
    text
}

fn listed(place: DVec3) -> String {
    format!("{:?}", place.to_array())
}

/// A room in the making; its floor is at height 0.
struct Room {
    world: World,
    half: DVec3,
    /// The smallest size by the largest.
    least: f64,
    random: Random,
}

impl Room {
    /// A length between the smallest of the room and `most`, any decade alike.
    fn length(&mut self, most: f64) -> f64 {
        most * libm::pow(self.least, self.random.unit())
    }

    fn caster(&mut self) -> usize {
        let kind = match self.random.below(4) {
            0 => mirror(self.random.between(0.7, 1.0)),
            _ => Material::clear(self.random.between(1.3, 1.7)),
        };
        material(&mut self.world, kind)
    }

    /// A ball on or a little above the floor.
    fn ball(&mut self, radius: f64, about: DVec3, reach: f64) -> Sphere {
        let away = at(self.random.between(-reach, reach), self.random.between(-reach, reach), 0.0);
        let height = radius * self.random.between(1.001, 2.0);
        let centre = at(about.x + away.x, about.y + away.y, height);
        Sphere { centre, radius, material: self.caster(), radiance: None }
    }

    /// Whether a ball is within the walls and apart from the others.
    fn fits(&self, centre: DVec3, radius: f64) -> bool {
        let inside = centre.x.abs() + radius < 0.95 * self.half.x
            && centre.y.abs() + radius < 0.95 * self.half.y
            && centre.z + radius < 1.9 * self.half.z;
        let apart = |ball: &Sphere| ball.centre.distance(centre) > 1.05 * (ball.radius + radius);
        inside && self.world.spheres.iter().all(apart)
    }

    /// The ball that the camera looks at.
    fn focus(&mut self) -> Sphere {
        let radius = self.length(0.25);
        let ball = self.ball(radius, DVec3::ZERO, 0.5);
        self.world.spheres.push(ball);
        ball
    }

    /// Up to three more, near or far.
    fn casters(&mut self, focus: Sphere) {
        for _ in 0..self.random.below(4) {
            let radius = self.length(0.25);
            let reach = (focus.radius + radius) * (1.5 + 10.0 * self.random.unit());
            let ball = self.ball(radius, focus.centre, reach);
            if self.fits(ball.centre, ball.radius) {
                self.world.spheres.push(ball);
            }
        }
    }

    /// One to three lamps above the focus, each of which brings about as much light.
    fn lamps(&mut self, focus: Sphere) {
        let count = 1 + self.random.below(3);
        let black = material(&mut self.world, grey(0.0));
        let mut placed = 0;
        while placed < count {
            let away = focus.radius * libm::pow(1.6 * self.half.z / focus.radius / 4.0, self.random.unit()) * 4.0;
            let tilt = at(self.random.between(-0.7, 0.7), self.random.between(-0.7, 0.7), 1.0).normalize();
            let (size, centre) = (self.length(0.2).min(0.2 * away), focus.centre + tilt * away);
            if !self.fits(centre, 1.5 * size) {
                continue;
            }
            let area = if self.random.below(2) == 0 { 4.0 * size * size } else { PI * size * size };
            let radiance = Some(2.0 * away * away / area);
            if area > PI * size * size {
                let (e1, e2) = (tilt.any_orthonormal_vector(), tilt.cross(tilt.any_orthonormal_vector()));
                quad(&mut self.world, centre, (e2 * size, e1 * size), black, radiance);
            } else {
                sphere(&mut self.world, centre, size, black, radiance);
            }
            placed += 1;
        }
    }

    fn camera(&mut self, focus: Sphere) {
        loop {
            let away = focus.radius * self.random.between(3.0, 8.0);
            let way = self.random.direction();
            let eye = focus.centre + at(way.x, way.y, 0.2 + way.z.abs()).normalize() * away;
            if self.fits(eye, 0.0) {
                let look_at = at(focus.centre.x, focus.centre.y, 0.3 * focus.centre.z);
                camera(&mut self.world, eye, look_at, self.random.between(40.0, 60.0) * PI / 180.0);
                return;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rooms_span_their_decades() {
        for (rooms, least) in [(0..24, 1e-3), (24..ROOMS, 1e-4)] {
            let radii = || rooms.clone().flat_map(|number| room(number).spheres).map(|ball| ball.radius);
            let [small, large] = [radii().fold(f64::INFINITY, f64::min), radii().fold(0.0, f64::max)];
            assert!(small < least && large > 0.1, "{small} to {large}");
        }
    }

    #[test]
    fn a_room_and_its_scene_file_are_the_same() {
        let folder = tempfile::tempdir().expect("a folder");
        for number in [0, 13, 29] {
            let file = folder.path().join("room.toml");
            std::fs::write(&file, scene_file(&room(number))).expect("it is written");
            let read = smalti_scene::load(&file).expect("it is read").world;
            assert_eq!(read.spheres, room(number).spheres, "room {number}");
            assert_eq!(read.polygons, room(number).polygons, "room {number}");
        }
    }

    #[test]
    fn a_room_is_closed_and_its_camera_stands_in_it() {
        for number in 0..ROOMS {
            let world = room(number);
            let (low, high) = world.bounds().expect("walls");
            let eye = world.cameras[0].eye;
            assert!(eye.cmpgt(low).all() && eye.cmplt(high).all(), "room {number}");
            assert!(world.spheres.iter().all(|ball| ball.centre.distance(eye) > ball.radius), "room {number}");
            assert_eq!(world.polygons.iter().filter(|polygon| polygon.radiance.is_none()).count(), 6);
        }
    }
}
