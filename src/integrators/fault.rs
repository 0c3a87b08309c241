//! Defects that integrators can be given on purpose, to test what judges them.

use core::f64::consts::PI;

use nephroid_analytic::class::PathClass;

use crate::geometry::scene::Overrides;

/// A defect modelled on what goes wrong in real renderers. `nephroid faults` runs them all; `src/museum` has their sources.
///
/// It is injected where the code would have it: by changing constants when the scene is prepared, or by compiling the
/// method a second time with hooks ([`super::deviation`]) that do nothing, and cost nothing, in a healthy integrator.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// The cosine at the receiver once more: in next event estimation, at a regularized connection's sampled direction,
    /// and on photons, whose flux has it already.
    CosineTwice,
    /// No cosine at the receiver: divided out where next event estimation and regularized connections have it.
    CosineForgotten,
    /// The kernel on the angle normalised on the tangent plane, by πα² for a cone, in place of the sphere. Changes
    /// nothing for kernels on a radius, for which it is right.
    KernelNormalizedByPiAlphaSquared,
    /// The kernel on the angle normalised by the disc that the cone cuts out of the tangent plane, π tan² α.
    KernelNormalizedByTangent,
    /// The full angle of the cone taken for its half angle in the comparison, not in the normalisation.
    FullAngleForHalf,
    /// The bandwidth in place of its square in the kernel's normalisation.
    RadiusForRadiusSquared,
    /// The normalisation of another kernel on the distance: Epanechnikov's for a disc, the disc's for any other.
    NormOfAnotherKernel,
    /// Bandwidths below 0.6 (rad or m) are raised to it, unannounced.
    BandwidthFloor,
    /// Bandwidths below 1e-7 are raised to it: never reached.
    TinyBandwidthFloor,
    /// The 1/cos of the delta BSDF kept when the delta is replaced by a kernel in solid angle.
    DeltaCosineKept,
    /// A cosine at the specular vertex, where the kernel in solid angle has none.
    CosineAtSpecularVertex,
    /// Directions uniform over the hemisphere, weighted as if they had the density cos θ/π.
    UniformForCosine,
    /// Regularized samples of radiance above 1 W m⁻² sr⁻¹ are clamped to it.
    SamplesClamped,
    /// Intensity (or irradiance of a directional light) 1 in place of the light's own.
    IntensityForgotten,
    /// Flux 4πI in place of the intensity I.
    FluxForIntensity,
    /// No inverse square of the distance to the light.
    NoFalloff,
    /// The inverse distance in place of its square.
    InverseDistance,
    /// Photons of a part of the sphere carry twice its flux, as if a hemisphere had been a sphere.
    HemisphereForSphere,
    /// Photons are drawn with another density than the one they are divided by.
    EmissionWarped,
    /// Photons over everything in place of what can matter: more variance, no bias.
    EmissionUnaimed,
    /// Albedo 1 in place of the floor's own.
    AlbedoForgotten,
    /// The square of the albedo.
    AlbedoTwice,
    /// The BSDF ρ in place of ρ/π.
    BsdfWithoutPi,
    /// The BSDF ρ/π².
    BsdfPiTwice,
    /// Reflectance 1 in place of the mirror's own. Changes nothing where there is no mirror.
    ReflectanceForgotten,
    /// The square of the mirror's reflectance.
    ReflectanceTwice,
    /// Transmittance 1 at the water's surface.
    FresnelForgotten,
    /// Reflectance and transmittance of the water's surface exchanged.
    FresnelSwapped,
    /// The relative index of the water inverted: light bends away from the normal.
    IndexInverted,
    /// Photons divided by n² when they enter the water, as radiance would be when it leaves it.
    EtaSquaredOnPhotons,
    /// Photons divided by n.
    EtaOnPhotons,
    /// The floor's cosine towards the pinhole missing in the connection of a light path.
    ConnectionWithoutCosine,
    /// The side of a pixel in place of its area in the connection of a light path.
    PixelSideForArea,
    /// Camera paths weighted by the cosine at the sensor, as if a pixel were to have irradiance.
    SensorCosine,
    /// The film of light paths divided by the number of those that arrived.
    SplatsPerSurvivor,
    /// The film of light paths divided by the number of its pixels: brighter with every path.
    SplatsPerPixelCount,
    /// Camera samples scaled like splats, divided by paths per pixel once more.
    SplatScaleOnCameraPaths,
    /// The image one row lower.
    ImageOneRowLow,
    /// The image half a pixel to the right and half a pixel lower.
    ImageHalfPixelOff,
    /// The image upside down.
    ImageFlipped,
    /// Contributions to the last row and column are lost.
    LastRowLost,
    /// No shadow rays in next event estimation.
    ShadowRayForgotten,
    /// Light paths are connected to the pinhole through the surface that hides them.
    ConnectionThroughSurface,
    /// Direct light counted by two strategies, each with its full weight.
    DirectLightTwice,
    /// Russian roulette whose survivors (three in four) are not weighted.
    RouletteUnweighted,
    /// The same, weighted: more variance, no bias.
    RouletteWeighted,
    /// Photons of direct light are merged together with those of the caustic.
    DirectPhotonsMerged,
    /// Photons divided by the number of those that were stored.
    DividedByStoredPhotons,
    /// Queries look at the four cells to one side of the nine.
    FourCellsOfNine,
    /// Cells half as wide as the radius: photons beyond the next cell are lost.
    CellsTooSmall,
    /// The first radius of a progressive method in every iteration.
    RadiusNotShrinking,
    /// The reduction of r² with half of its exponent.
    ScheduleExponentHalved,
    /// The recursion of radii starts one iteration too late in its own count.
    RecursionOffByOne,
    /// Sums of old iterations divided by the newest normalisation.
    NewestNormalization,
    /// One pixel that is not a number.
    NotANumberPixel,
    /// One pixel that is infinite.
    InfinitePixel,
    /// One pixel that is negative.
    NegativePixel,
    /// One random number in two dimensions of emission, or of the scattered direction.
    SameNumberTwice,
    /// Six bits of the seed: replicates repeat.
    SeedTruncated,
    /// All iterations of a replicate use the same random numbers: more variance, no bias.
    IterationsShareNumbers,
    /// Landing points of light paths rounded to single precision, in a scene 1e6 m away from the origin.
    SinglePrecision,
    /// Specular manifold sampling: the surface area per area at a point light is clamped at 1, the solid angle per solid angle
    /// of parallel light at 10.
    ManifoldJacobianClamped,
    /// Specular manifold sampling: the generalised geometry term is clamped at 2 (per m² for a point light).
    GeneralizedGeometryClamped,
    /// Specular manifold sampling: solutions in directions whose cosine is within 1e-4 of 1 are taken for one.
    SolutionsMerged,
    /// Specular manifold sampling: a walk ends where its next step is 1e-3 of the distance.
    ResidualLoose,
    /// Specular manifold sampling: the different solutions of four walks, with the weight 1.
    FixedNumberOfWalks,
    /// Specular manifold sampling: a solution that four further walks do not find again is dropped.
    TrialsBounded,
    /// Specular manifold sampling: the reciprocal probability is the number of failures before the solution is found again.
    ReciprocalOffByOne,
    /// Specular manifold sampling: the first solution counts with the weight 1.
    ReciprocalForgotten,
    /// The balance heuristic for the weights of one side, the power heuristic for those of the other.
    HeuristicsMixed,
    /// The density of camera subpaths not divided by the number of pixels in the weights of light tracing, and divided in
    /// those of next event estimation.
    MisPixelsForgotten,
    /// In the weights of the light's side, the camera's density in solid angle for the one per area.
    MisMeasuresMixed,
    /// The same in the weights of both sides, which still sum to 1: more variance, no bias.
    MisMeasuresWrong,
    /// Both techniques of a mollified vertex with full weight.
    MollifiedTwice,
    /// Each technique of a mollified vertex evaluates the kernel of its own side: they estimate different integrals, and are
    /// weighted as if they were the same.
    SidesDiffer,
    /// Classes that can be sampled are mollified as well.
    RegularRegularized,
    /// A path through a specular vertex next to the eye is weighted as if light tracing could build it too.
    DeltaVertexWeighted,
    /// Aimed photons carry the flux of the whole sphere.
    SphereFluxOnAimedPhotons,
    /// The radius of a pass is chosen with a look at the photons of that pass.
    RadiusFromCurrentPhotons,
    /// The recursion of r² applied to r.
    RecursionOnRadius,
    /// The radius in place of its square in the weights of merges, not in those of connections.
    MergingWeightByRadius,
    /// Paths that are connected and merged count fully in both.
    ConnectedAndMerged,
    /// Merges have the weight of the connections.
    BidirectionalWeightOnMerges,
    /// Merges are divided by the count that is in the weights, not by the photons of their map.
    MergesByNominalCount,
    /// The paths of one class are lost.
    ClassDropped(PathClass),
}

impl Fault {
    /// What the fault does to the scene's constants.
    pub(super) fn overrides(self) -> Overrides {
        let mut o = Overrides::default();
        match self {
            Fault::IntensityForgotten => o.light = Some(|_| 1.0),
            Fault::FluxForIntensity => o.light = Some(|i| 4.0 * PI * i),
            Fault::AlbedoForgotten => o.albedo = Some(|_| 1.0),
            Fault::AlbedoTwice => o.albedo = Some(|rho| rho * rho),
            Fault::BsdfWithoutPi => o.albedo = Some(|rho| rho * PI),
            Fault::BsdfPiTwice => o.albedo = Some(|rho| rho / PI),
            Fault::ReflectanceForgotten => o.reflectance = Some(|_| 1.0),
            Fault::ReflectanceTwice => o.reflectance = Some(|r| r * r),
            Fault::FresnelForgotten => o.transmittance = Some(|_| [1.0, 0.0]),
            Fault::FresnelSwapped => o.transmittance = Some(|_| [1.0, -1.0]),
            Fault::IndexInverted => o.index = Some(|n| 1.0 / n),
            Fault::EtaSquaredOnPhotons => o.transmittance = Some(|n| [0.0, 1.0 / (n * n)]),
            Fault::EtaOnPhotons => o.transmittance = Some(|n| [0.0, 1.0 / n]),
            _ => {}
        }
        o
    }
}
