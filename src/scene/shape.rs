//! Shapes, each with its named parameters. The table below is the only list of them: the enum, the file format, the
//! inspector, the packing for the GPU, the tests and the golden sheet follow from it.
//!
//! To add one: an entry here, its bounds in `shape/extent.rs`, `sdf_name` in `field/eval/sdf/` and in `shaders/sdf/`.
//! `CONTRIBUTING.md` shows an example. Both functions get the parameters as a struct `NameParams`, with the names of
//! the table. A shape `with data` is evaluated from a payload that `field::PreparedShape` derives from its parameters;
//! what its struct has stands behind `data`.

use schemars::JsonSchema;
use serde::Serialize;

use super::attachment::Attachment;
use super::drawn::{Corners, Points};
use super::eval_params::{EvalParams, ParamLayout};
use super::heights::Heights;
use super::limits::{
    ARC, CLIP_NAME_LENGTH, CLIP_TIME, CONE, CONSTANT, FOLD, FREQUENCY, ITERATIONS, LETTERS, NO_LIMITS, OCTAVES,
    OPTIONAL_PATH_LENGTH, POSITION, POWER, REACH, SECTOR, SEED, SIDES, SIZE, SQUARES, THICKNESS, TURN, UNIT,
    VOXEL_SIZE, VOXELS, WAVELENGTH,
};
use super::model_file::ModelFile;
use isolith_font::Face;

#[macro_use]
mod define;
mod extent;
mod packed;

#[cfg(test)]
mod tests;

use packed::Packed;
pub use packed::{Degrees, SHAPE_FLOATS, Sides};

shapes! {
    /// A ball.
    Sphere = sdf_sphere(SphereParams), "Sphere" {
        /// Distance from the center to the surface.
        radius: f64 = 0.5, SIZE;
    }
    /// A ball stretched along its axes; exact distance.
    Ellipsoid = sdf_ellipsoid(EllipsoidParams), "Ellipsoid" {
        /// Half axes along X, Y and Z.
        radii: [f64; 3] = [0.7, 0.4, 0.5], SIZE;
    }
    /// A cuboid, its edges rounded inward so that its size stays.
    Box = sdf_box(BoxParams), "Box" {
        /// Edge lengths.
        size: [f64; 3] = [1.0; 3], SIZE;
        /// Radius of the edges; at most half the shortest edge takes effect.
        rounding: f64 = 0.0, THICKNESS.labeled("Bevel");
    }
    /// The twelve edges of a cuboid, as bars.
    BoxFrame = sdf_box_frame(BoxFrameParams), "Box frame" {
        /// Outer edge lengths.
        size: [f64; 3] = [1.0; 3], SIZE;
        /// Width of the bars.
        thickness: f64 = 0.1, THICKNESS;
    }
    /// A ring around the Y axis.
    Torus = sdf_torus(TorusParams), "Torus" {
        /// From the axis to the middle of the tube.
        major_radius: f64 = 0.5, SIZE;
        /// Of the tube.
        minor_radius: f64 = 0.15, SIZE;
    }
    /// A cylinder along the Y axis, its edges rounded inward.
    Cylinder = sdf_cylinder(CylinderParams), "Cylinder" {
        /// From the axis to the side.
        radius: f64 = 0.5, SIZE;
        /// From cap to cap.
        height: f64 = 1.0, SIZE;
        /// Radius of the edges; at most the radius and half the height take effect.
        rounding: f64 = 0.0, THICKNESS.labeled("Bevel");
    }
    /// A cone along the Y axis, cut flat at both ends.
    CappedCone = sdf_capped_cone(CappedConeParams), "Truncated cone" {
        /// Radius of the lower cap.
        bottom_radius: f64 = 0.5, SIZE;
        /// Radius of the upper cap.
        top_radius: f64 = 0.2, SIZE;
        /// From cap to cap.
        height: f64 = 1.0, SIZE;
    }
    /// The hull of two balls on the Y axis.
    RoundCone = sdf_round_cone(RoundConeParams), "Round cone" {
        /// Radius of the lower ball, whose center is the lower end.
        bottom_radius: f64 = 0.4, SIZE;
        /// Radius of the upper ball.
        top_radius: f64 = 0.2, SIZE;
        /// Between the centers of the balls; the origin is half-way.
        height: f64 = 0.8, SIZE;
    }
    /// Everything within a distance of a segment.
    Capsule = sdf_capsule(CapsuleParams), "Capsule" {
        /// One end of the segment.
        start: [f64; 3] = [0.0, -0.4, 0.0], POSITION;
        /// The other end.
        end: [f64; 3] = [0.0, 0.4, 0.0], POSITION;
        /// From the segment to the surface.
        radius: f64 = 0.25, SIZE;
    }
    /// Everything below the XZ plane; has no end.
    Plane = sdf_plane(PlaneParams), "Plane (half space)" {}
    /// A hexagonal prism along the Y axis.
    HexagonalPrism = sdf_hexagonal_prism(HexagonalPrismParams), "Hexagonal prism" {
        /// From the axis to the middle of a side; two sides face along X.
        radius: f64 = 0.5, SIZE;
        /// From cap to cap.
        height: f64 = 0.5, SIZE;
    }
    /// A regular octahedron with its corners on the axes.
    Octahedron = sdf_octahedron(OctahedronParams), "Octahedron" {
        /// From the center to a corner.
        radius: f64 = 0.6, SIZE;
    }
    /// A ring of which only an arc is left, with round ends.
    CappedTorus = sdf_capped_torus(CappedTorusParams), "Capped torus" {
        /// From the axis to the middle of the tube.
        major_radius: f64 = 0.5, SIZE;
        /// Of the tube.
        minor_radius: f64 = 0.13, SIZE;
        /// From the middle of the arc, which lies on X, to either end.
        half_angle: Degrees = Degrees(120.0), ARC;
    }
    /// A link of a chain: a ring around the Y axis, pulled apart along X.
    Link = sdf_link(LinkParams), "Chain link" {
        /// Of the straight part.
        length: f64 = 0.5, SIZE;
        /// From the middle of a bend to the middle of the tube.
        major_radius: f64 = 0.3, SIZE;
        /// Of the tube.
        minor_radius: f64 = 0.1, SIZE;
    }
    /// A cone that opens downward from its tip at the origin; has no end.
    Cone = sdf_cone(ConeParams), "Infinite cone" {
        /// Between the axis and the side.
        half_angle: Degrees = Degrees(30.0), CONE;
    }
    /// A cylinder along the Y axis; has no ends.
    InfiniteCylinder = sdf_infinite_cylinder(InfiniteCylinderParams), "Infinite cylinder" {
        /// From the axis to the side.
        radius: f64 = 0.35, SIZE;
    }
    /// A prism along the Y axis over an isosceles triangle.
    TriangularPrism = sdf_triangular_prism(TriangularPrismParams), "Triangular prism" {
        /// Of the side along X, which lies toward -Z.
        width: f64 = 1.0, SIZE;
        /// From that side to the corner, along Z.
        depth: f64 = 0.87, SIZE;
        /// From cap to cap.
        height: f64 = 0.6, SIZE;
    }
    /// A prism along the Y axis over a regular polygon, its edges rounded inward.
    Prism = sdf_prism(PrismParams), "Prism" {
        /// Of the polygon; a whole number.
        sides: Sides = Sides(5.0), SIDES;
        /// From the axis to the middle of a side; one of them faces along X.
        radius: f64 = 0.5, SIZE;
        /// From cap to cap.
        height: f64 = 0.7, SIZE;
        /// Radius of the edges; at most the radius and half the height take effect.
        rounding: f64 = 0.0, THICKNESS.labeled("Bevel");
    }
    /// A pyramid over a square, its tip on the Y axis.
    Pyramid = sdf_pyramid(PyramidParams), "Pyramid" {
        /// Edge length of the square.
        width: f64 = 1.1, SIZE;
        /// From the square to the tip; the origin is half-way.
        height: f64 = 0.9, SIZE;
    }
    /// A prism along the Y axis over a rhombus with its corners on X and Z, its edges rounded inward.
    Rhombus = sdf_rhombus(RhombusParams), "Rhombus" {
        /// From corner to corner along X.
        width: f64 = 1.2, SIZE;
        /// From corner to corner along Z.
        depth: f64 = 0.8, SIZE;
        /// From cap to cap.
        height: f64 = 0.4, SIZE;
        /// Radius of the edges; at most what fits into the rhombus and half the height take effect.
        rounding: f64 = 0.06, THICKNESS.labeled("Bevel");
    }
    /// A ball cut flat; what is above the cut stays.
    CutSphere = sdf_cut_sphere(CutSphereParams), "Dome" {
        /// Of the ball.
        radius: f64 = 0.6, SIZE;
        /// Height of the cut over the ball's center, within the ball.
        cut: f64 = -0.1, POSITION;
    }
    /// A bowl: the skin of a ball, cut open above, with a round rim.
    HollowCutSphere = sdf_hollow_cut_sphere(HollowCutSphereParams), "Bowl" {
        /// Of the ball, to the middle of the skin.
        radius: f64 = 0.55, SIZE;
        /// Height of the cut over the ball's center, within the ball.
        cut: f64 = 0.15, POSITION;
        /// Of the skin.
        thickness: f64 = 0.1, THICKNESS;
    }
    /// A ball out of which another ball above it is cut.
    DeathStar = sdf_death_star(DeathStarParams), "Death star" {
        /// Of the ball.
        radius: f64 = 0.6, SIZE;
        /// Of the ball that is cut out; never takes all.
        cut_radius: f64 = 0.45, SIZE;
        /// Between the centers, along Y.
        distance: f64 = 0.7, SIZE;
    }
    /// The part of a ball within an angle around the Y axis.
    SolidAngle = sdf_solid_angle(SolidAngleParams), "Solid angle" {
        /// Of the ball.
        radius: f64 = 0.9, SIZE;
        /// Between the axis and the side.
        half_angle: Degrees = Degrees(35.0), SECTOR;
    }
    /// A spindle along the Y axis: an arc turned about its chord.
    Vesica = sdf_vesica(VesicaParams), "Spindle" {
        /// From tip to tip.
        height: f64 = 1.3, SIZE;
        /// Where it is thickest; at most the height takes effect.
        width: f64 = 0.7, SIZE;
    }
    /// A triangle in the XZ plane, with a thickness and round edges.
    Triangle = sdf_triangle(TriangleParams), "Triangle" {
        /// Of the side along X, which lies toward -Z.
        width: f64 = 1.1, SIZE;
        /// From that side to the corner, along Z.
        depth: f64 = 1.0, SIZE;
        /// How far the corner is off the middle, along X.
        skew: f64 = 0.0, POSITION;
        /// From face to face.
        thickness: f64 = 0.08, THICKNESS;
    }
    /// A rectangle or parallelogram in the XZ plane, with a thickness and round edges.
    Quad = sdf_quad(QuadParams), "Quad" {
        /// Of the sides along X.
        width: f64 = 1.0, SIZE;
        /// Between these sides, along Z.
        depth: f64 = 0.8, SIZE;
        /// How far the side toward +Z is shifted against the other, along X.
        skew: f64 = 0.2, POSITION;
        /// From face to face.
        thickness: f64 = 0.08, THICKNESS;
    }
    /// A prism along the Y axis over a star, its edges rounded inward.
    Star = sdf_star(StarParams), "Star" {
        /// Points of the star, one of them on X; a whole number.
        points: Sides = Sides(5.0), SIDES;
        /// From the axis to a point.
        outer_radius: f64 = 0.65, SIZE;
        /// From the axis to a notch.
        inner_radius: f64 = 0.3, SIZE;
        /// From cap to cap.
        height: f64 = 0.3, SIZE;
        /// Radius of the edges; at most what fits into the star and half the height take effect.
        rounding: f64 = 0.0, THICKNESS.labeled("Bevel");
    }
    /// A ring around the Y axis with a regular polygon as its section.
    PolygonRing = sdf_polygon_ring(PolygonRingParams), "Polygon ring" {
        /// Of the polygon; a whole number.
        sides: Sides = Sides(6.0), SIDES;
        /// From the axis to the middle of the polygon.
        major_radius: f64 = 0.5, SIZE;
        /// From the middle of the polygon to the middle of a side; one of them faces outward.
        minor_radius: f64 = 0.14, SIZE;
    }
    /// A cube with square holes, in each of its parts again.
    MengerSponge = sdf_menger_sponge(MengerSpongeParams), "Menger sponge" {
        /// Edge length.
        size: f64 = 1.0, SIZE;
        /// How often holes are made, each time a third as wide; a whole number.
        iterations: f64 = 3.0, ITERATIONS;
    }
    /// A Julia set of quaternions: where z² + c, repeated, stays near.
    Julia = sdf_julia(JuliaParams), "Julia set" {
        /// Of the ball that holds it.
        radius: f64 = 0.8, SIZE;
        /// The first three numbers of the quaternion c.
        constant: [f64; 3] = [-0.2, 0.8, 0.0], CONSTANT;
        /// The fourth number of c, along the axis that is not seen.
        fourth: f64 = 0.0, CONSTANT;
        /// How often it is repeated; a whole number.
        iterations: f64 = 9.0, SQUARES;
    }
    /// A pseudo-Kleinian set: folded at a box and turned inside out, again and again.
    Kleinian = sdf_kleinian(KleinianParams), "Kleinian set" {
        /// Of the ball that holds it.
        radius: f64 = 0.8, SIZE;
        /// How much of the set the ball shows: its radius in the set's own unit.
        reach: f64 = 2.0, REACH;
        /// Half the box at which space is folded, in that unit.
        fold: [f64; 3] = [1.0, 0.5, 1.0], FOLD;
        /// Square of the radius within which space is turned inside out, in that unit.
        inversion: f64 = 0.5, FOLD;
        /// How thick the set is drawn, in that unit.
        thickness: f64 = 0.06, FOLD;
        /// How often it is folded; a whole number.
        iterations: f64 = 4.0, ITERATIONS;
    }
    /// A Mandelbulb: where zⁿ + c, repeated from c on, stays near; a power of angles and distances.
    Mandelbulb = sdf_mandelbulb(MandelbulbParams), "Mandelbulb" {
        /// Of the ball that holds it.
        radius: f64 = 0.7, SIZE;
        /// The power n: one more than the number of large bulbs around the axis; a whole number.
        power: f64 = 8.0, POWER;
        /// How often it is repeated; a whole number.
        iterations: f64 = 2.0, SQUARES;
    }
    /// A round tube along a smooth curve through points; its ends are balls.
    Tube = sdf_tube(TubeParams) with data {
        /// Pieces of the curve.
        pieces: u32,
        /// Groups of pieces, each with a ball around it.
        groups: u32,
    }, "Curve tube" {
        /// Points of the curve, each with a radius.
        points: Points = Points::new([[-0.6, -0.2, 0.0, 0.0], [-0.2, 0.25, 0.15, 0.0], [0.2, -0.25, -0.15, 0.0], [0.6, 0.2, 0.0, 0.0]]), POSITION;
        /// Added to the radius of each point.
        radius: f64 = 0.12, SIZE;
        /// Whether the curve returns to its first point.
        closed: bool = false, NO_LIMITS;
    }
    /// A drawn profile in the XY plane, as thick as its depth along Z.
    Extrusion = sdf_extrusion(ExtrusionParams) with data {
        /// Groups of pieces of the profile, each with a box around it.
        groups: u32,
        /// Half the thickness.
        half_depth: f64,
        /// Radius of the edges, at most half the thickness.
        rounding: f64,
    }, "Extrusion" {
        /// Corners of the profile; the last is joined to the first.
        corners: Corners = Corners::star(5, 0.6, 0.28), POSITION;
        /// Whether the profile is a smooth curve through the corners.
        smooth: bool = false, NO_LIMITS;
        /// From face to face.
        depth: f64 = 0.3, SIZE;
        /// Radius of the edges of the faces, inward.
        rounding: f64 = 0.0, THICKNESS.labeled("Bevel");
    }
    /// A drawn profile in the XY plane, turned around the Y axis; what lies on the other side of the axis is left out.
    Revolution = sdf_revolution(RevolutionParams) with data {
        /// Groups of pieces of the profile, each with a box around it.
        groups: u32,
    }, "Lathe" {
        /// Corners of the profile; the last is joined to the first.
        corners: Corners = Corners::vase(), POSITION;
        /// Whether the profile is a smooth curve through the corners.
        smooth: bool = false, NO_LIMITS;
        /// How far the profile is moved away from the axis.
        offset: f64 = 0.0, POSITION;
    }
    /// A text of solid letters in the XY plane, as thick as its depth along Z.
    Text = sdf_text(TextParams) with data {
        /// Groups of pieces of the letters, each with a box around it.
        groups: u32,
        /// Half the thickness.
        half_depth: f64,
        /// Radius of the edges, at most half the thickness.
        rounding: f64,
    }, "Text" {
        /// What is written; `\n` begins a line.
        text: String = "Text".to_owned(), LETTERS;
        /// The font; letters that it does not have come from the editor's.
        #[serde(default)]
        font: Attachment<Face> = Attachment::NONE, NO_LIMITS;
        /// Height of the font; capital letters have seven tenths of it.
        size: f64 = 0.6, SIZE;
        /// From face to face.
        depth: f64 = 0.15, SIZE;
        /// Radius of the edges of the faces, inward.
        rounding: f64 = 0.0, THICKNESS.labeled("Bevel");
    }
    /// Hills: fractal noise over a rectangle, solid down to a flat bottom.
    Terrain = sdf_terrain(TerrainParams) with data {
        /// Half the width and half the length.
        half: [f64; 2],
        /// From the mean height down to the bottom.
        depth: f64,
        /// Greatest height.
        top: f64,
        /// One over √(1 + L²) for the steepest slope L.
        slope: f64,
        /// Layers of noise, one a row.
        layers: u32,
        /// Another number, another landscape.
        seed: u32,
    }, "Terrain" {
        /// Width, depth of the ground below the mean height, length.
        size: [f64; 3] = [2.0, 0.4, 2.0], SIZE;
        /// Greatest height above and below the mean.
        amplitude: f64 = 0.35, SIZE;
        /// Size of the largest hills.
        wavelength: f64 = 0.8, WAVELENGTH;
        /// How many layers of ever finer noise.
        octaves: f64 = 5.0, OCTAVES;
        /// How high each layer is relative to the one before it.
        roughness: f64 = 0.45, UNIT;
        /// Another number, another landscape.
        seed: f64 = 1.0, SEED;
    }
    /// A landscape from an image, the brighter the higher; solid down to a flat bottom.
    Heightmap = sdf_heightmap(HeightmapParams) with data {
        /// Half the width and half the length.
        half: [f64; 2],
        /// From the mean height down to the bottom.
        depth: f64,
        /// Greatest height.
        top: f64,
        /// One over √(1 + L²) for the steepest slope L.
        slope: f64,
        /// Columns and lines of heights, one a row.
        cells: [f64; 2],
    }, "Heightmap" {
        /// Its pixels are heights; an image larger than 256 pixels is made smaller.
        #[serde(default)]
        image: Attachment<Heights> = Attachment::NONE, NO_LIMITS;
        /// Width, depth of the ground below what is black, length.
        size: [f64; 3] = [2.0, 0.2, 2.0], SIZE;
        /// Of what is white above what is black.
        height: f64 = 0.7, SIZE;
    }
    /// Water with waves over a rectangle, solid down to a flat bottom.
    Ocean = sdf_ocean(OceanParams) with data {
        /// Half the width and half the length.
        half: [f64; 2],
        /// From the mean height down to the bottom.
        depth: f64,
        /// Greatest height.
        top: f64,
        /// One over √(1 + L²) for the steepest slope L.
        slope: f64,
        /// Waves, one a row.
        waves: u32,
        /// Twice the height of the second harmonic of each wave, over that of the wave.
        harmonic: f64,
    }, "Ocean" {
        /// Width, depth of the water, length.
        size: [f64; 3] = [2.0, 0.3, 2.0], SIZE;
        /// Height of the waves above and below the mean, all together.
        amplitude: f64 = 0.08, SIZE;
        /// Length of the longest wave.
        wavelength: f64 = 0.9, WAVELENGTH;
        /// How many waves.
        waves: f64 = 6.0, OCTAVES;
        /// Where they run to, seen from above: 0 is along X, 90 along Z.
        direction: f64 = 30.0, TURN;
        /// How far the waves run apart, to either side of the direction.
        spread: f64 = 50.0, TURN;
        /// How pointed the crests are.
        sharpness: f64 = 0.5, UNIT;
        /// Where the waves are in their motion: 360 is a whole turn of the longest.
        phase: f64 = 0.0, TURN;
        /// How fast they run: periods of the longest wave per second.
        #[serde(default)]
        speed: f64 = 0.0, FREQUENCY;
    }
    /// The solid of a glTF model, as distances in voxels.
    MeshField = sdf_mesh_field(MeshFieldParams) with data {}, "Mesh field" {
        /// A .gltf or .glb file, relative to the scene's folder.
        #[serde(default)]
        file: ModelFile = ModelFile::default(), OPTIONAL_PATH_LENGTH;
        /// The animation clip that poses it, by its name or its number in the file; empty for the rest pose.
        #[serde(default)]
        clip: String = String::new(), CLIP_NAME_LENGTH.labeled("Clip");
        /// The moment of the clip.
        #[serde(default)]
        clip_time: f64 = 0.0, CLIP_TIME;
        /// Voxels along its longest side; 0 leaves the choice to the model.
        #[serde(default)]
        resolution: f64 = 0.0, VOXELS;
        /// Size of a voxel, in place of the resolution; 0 for none.
        #[serde(default)]
        voxel_size: f64 = 0.0, VOXEL_SIZE;
        /// Shows the file's own materials and textures, where it has some, in place of the node's material.
        file_materials: bool = true, NO_LIMITS.fixed();
    }
}
