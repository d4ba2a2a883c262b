//! A thousand randomly broken files: the reader reads or refuses each and never panics or hangs.

use std::path::Path;
use std::time::{Duration, Instant};

use glam::{DVec3, DVec4};
use isolith::geometry::Ray;
use isolith::mesh::{TriangleMesh, load, parse};

use super::asset::scenes;
use super::tiny::{Random, everything, posed};

/// Numbers that break arithmetic without checks.
const NASTY: [&str; 12] = [
    "0",
    "1",
    "-1",
    "3",
    "255",
    "65536",
    "4294967295",
    "9223372036854775807",
    "18446744073709551615",
    "1e300",
    "0.5",
    "[]",
];

/// One to three changes: bytes flipped, removed or duplicated; numbers replaced.
fn mutate(bytes: &[u8], text: std::ops::Range<usize>, random: &mut Random) -> Vec<u8> {
    let mut out = bytes.to_vec();
    for _ in 0..1 + random.below(2) * random.below(3) {
        let at = random.below(out.len().max(1));
        match random.below(8) {
            0 if !out.is_empty() => out[at] ^= 1 << random.below(8),
            1 if !out.is_empty() => out[at] = random.next() as u8,
            2 if random.below(4) == 0 => out.truncate(at),
            3 => {
                let end = (at + random.below(16)).min(out.len());
                let piece = out[at..end].to_vec();
                let target = random.below(out.len() + 1);
                out.splice(target..target, piece);
            }
            _ => replace_number(&mut out, text.clone(), random),
        }
    }
    out
}

fn replace_number(out: &mut Vec<u8>, text: std::ops::Range<usize>, random: &mut Random) {
    let from = text.start + random.below(text.len());
    let Some(start) = (from..out.len().min(text.end)).find(|i| out[*i].is_ascii_digit()) else { return };
    let digits = out[start..].iter().take_while(|b| b.is_ascii_digit()).count();
    let with = NASTY[random.below(NASTY.len())];
    out.splice(start..start + digits, with.bytes());
}

fn check_sound(mesh: &TriangleMesh) {
    let vertices = mesh.positions.len();
    assert!(vertices == mesh.normals.len() && vertices == mesh.colors.len() && vertices == mesh.uvs.len());
    assert!(!mesh.indices.is_empty() && mesh.indices.len().is_multiple_of(3));
    assert!(mesh.indices.iter().all(|i| (*i as usize) < vertices));
    assert!(mesh.positions.iter().chain(&mesh.normals).flatten().all(|c| c.is_finite()));
    assert!(mesh.colors.iter().flatten().all(|c| c.is_finite()));
    assert!(mesh.uvs.iter().flatten().all(|c| c.is_finite()));
    assert!(mesh.parts.iter().all(|p| p.origin.is_finite()));
    assert_eq!(mesh.parts.first().map(|p| p.indices.start), Some(0));
    assert_eq!(mesh.parts.last().map(|p| p.indices.end as usize), Some(mesh.indices.len()));
    assert!(mesh.parts.iter().all(|p| {
        let all = p.surface.maps().into_iter().chain([p.surface.base_color]);
        all.flatten().all(|used| used.texture < mesh.textures.len() && used.slot < 2)
    }));
    let ray = Ray { origin: mesh.bounds.center() + DVec3::new(0.01, 0.02, 3.0), direction: DVec3::NEG_Z };
    if let Some(hit) = mesh.hit(&ray, f64::INFINITY) {
        let opacity = mesh.color(hit.triangle, hit.weights, |_| DVec4::ONE).w;
        assert!(hit.t >= 0.0 && (-1e-6..=1.000_001).contains(&opacity), "{hit:?}: {opacity}");
    }
}

fn check(bytes: &[u8], text: std::ops::Range<usize>, count: usize, seed: u64) -> (usize, usize) {
    let mut random = Random(seed);
    let (mut read, mut refused) = (0, 0);
    for i in 0..count {
        let broken = mutate(bytes, text.clone(), &mut random);
        let start = Instant::now();
        match parse(&broken, Path::new("mutated"), None) {
            Ok(mesh) => {
                check_sound(&mesh);
                read += 1;
            }
            Err(error) => {
                assert!(!error.reason.is_empty());
                assert!(
                    !error.reason.contains("cannot be named") && !error.reason.contains("cannot name"),
                    "{i}: panic"
                );
                refused += 1;
            }
        }
        assert!(start.elapsed() < Duration::from_secs(5), "file {i} of seed {seed} took {:?}", start.elapsed());
    }
    (read, refused)
}

#[test]
fn a_thousand_mutated_files_are_read_or_refused() {
    let tiny = everything();
    let (gltf, glb, posed) = (tiny.gltf(), tiny.glb(), posed().gltf());
    let json = 20..20 + serde_json::to_vec(&tiny.json).unwrap().len();
    let suzanne = std::fs::read(scenes().join("models/suzanne.glb")).unwrap();
    assert!(load(&scenes().join("models/suzanne.glb")).is_ok() && parse(&gltf, Path::new("whole"), None).is_ok());
    check_sound(&parse(&posed, Path::new("posed"), None).unwrap());
    let results = [
        check(&gltf, 0..gltf.len(), 300, 11),
        check(&glb, json, 300, 12),
        check(&suzanne, 20..1_000, 100, 13),
        check(&posed, 0..posed.len(), 300, 14),
    ];
    let (read, refused) = results.iter().fold((0, 0), |(r, f), (read, refused)| (r + read, f + refused));
    assert_eq!(read + refused, 1_000);
    // Both outcomes occur: harmless changes and harmful ones.
    assert!(read > 100 && refused > 500, "{read} read, {refused} refused");
}
