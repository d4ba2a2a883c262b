//! Translation, rotation and scale: the transform that an artist edits.

use glam::{DAffine3, DMat3, DQuat, DVec3};

/// Scale first, then rotation, then translation. The three are stored, and never recovered by decomposing a matrix,
/// so that the file holds what the artist typed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transform {
    /// The image of the origin.
    pub translation: DVec3,
    /// Unit quaternion.
    pub rotation: DQuat,
    /// Factor per local axis; may differ and may be negative (a mirror image), never zero.
    pub scale: DVec3,
}

impl Transform {
    /// The identity.
    pub const IDENTITY: Self = Self { translation: DVec3::ZERO, rotation: DQuat::IDENTITY, scale: DVec3::ONE };

    /// A translation only.
    pub const fn from_translation(translation: DVec3) -> Self {
        Self { translation, ..Self::IDENTITY }
    }

    /// `parent_from_local` as an affine map.
    pub fn to_affine(&self) -> DAffine3 {
        DAffine3::from_scale_rotation_translation(self.scale, self.rotation, self.translation)
    }
}

impl Default for Transform {
    fn default() -> Self {
        Self::IDENTITY
    }
}

/// The least and the greatest factor by which the linear map `m` stretches a length: its extreme singular values, as
/// square roots of the extreme eigenvalues of mᵀm. The eigenvalues come from Jacobi rotations, which keep small ones
/// accurate.
pub fn singular_values(m: &DMat3) -> (f64, f64) {
    let mut a = (m.transpose() * *m).to_cols_array_2d();
    for _ in 0..16 {
        let mut off = 0.0;
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            off += a[p][q] * a[p][q];
            if a[p][q] == 0.0 {
                continue;
            }
            let theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
            let t = theta.signum() / (theta.abs() + (theta * theta + 1.0).sqrt());
            let c = 1.0 / (t * t + 1.0).sqrt();
            let s = t * c;
            for k in 0..3 {
                let (kp, kq) = (a[k][p], a[k][q]);
                a[k][p] = c * kp - s * kq;
                a[k][q] = s * kp + c * kq;
            }
            for k in 0..3 {
                let (pk, qk) = (a[p][k], a[q][k]);
                a[p][k] = c * pk - s * qk;
                a[q][k] = s * pk + c * qk;
            }
        }
        if off < 1e-300 {
            break;
        }
    }
    let d = [a[0][0], a[1][1], a[2][2]].map(|v| v.max(0.0).sqrt());
    (d[0].min(d[1]).min(d[2]), d[0].max(d[1]).max(d[2]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn singular_values_of_a_sheared_chain_bound_every_stretch() {
        let parent = DMat3::from_diagonal(DVec3::new(3.0, 0.25, 1.0));
        let child = DMat3::from_quat(DQuat::from_euler(glam::EulerRot::XYZ, 0.4, 0.9, -0.3));
        let m = parent * child * DMat3::from_diagonal(DVec3::new(1.0, 2.0, 1.0));
        let (least, greatest) = singular_values(&m);
        let (mut lo, mut hi) = (f64::INFINITY, 0.0_f64);
        for i in 0..20_000 {
            let z = 1.0 - 2.0 * (f64::from(i) + 0.5) / 20_000.0;
            let (s, c) = (f64::from(i) * 2.399_963_229_728_653).sin_cos();
            let r = (1.0 - z * z).sqrt();
            let stretch = (m * DVec3::new(r * c, r * s, z)).length();
            lo = lo.min(stretch);
            hi = hi.max(stretch);
        }
        assert!(least <= lo + 1e-12 && lo < least * 1.01, "{least} {lo}");
        assert!(greatest >= hi - 1e-12 && hi > greatest * 0.99, "{greatest} {hi}");
    }
}
