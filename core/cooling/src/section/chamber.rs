//! A chamber of one section: a ring of eight segments.

use super::camber::Camber;
use super::closure::{End, closure, past_camber};
use super::march::MarchLimits;
use super::outline::Outline;
use super::refusal::Refusal;
use super::segment::Segment;
use glam::DVec2;

/// Segments of a ring: suction side, three of the back closure, pressure side, three of the front closure.
pub const SEGMENTS: usize = 8;

/// How a chamber ends at its front or back.
#[derive(Clone, Debug, PartialEq)]
pub enum ClosureKind {
    /// The offset profile runs on round the leading edge (front only).
    Natural {
        /// Parameters at which the sides begin: pressure side, suction side.
        ends: (f64, f64),
    },
    /// An arc that touches both sides.
    Rounded {
        /// Its radius, mm of the chart.
        radius: f64,
    },
    /// A wall with fillets.
    Wall(WallRequest),
}

impl ClosureKind {
    fn describe(&self, end: End) -> String {
        match (self, end) {
            (Self::Wall(wall), _) => format!("wall {}", wall.name),
            (_, End::Front) => "the leading end".to_owned(),
            (_, End::Back) => "the trailing end".to_owned(),
        }
    }

    /// The same closure with the radii of its arcs times `factor`.
    fn with_radii_times(&self, factor: f64) -> Self {
        match self {
            Self::Natural { .. } => self.clone(),
            Self::Rounded { radius } => Self::Rounded { radius: radius * factor },
            Self::Wall(wall) => Self::Wall(WallRequest { fillet: wall.fillet * factor, ..wall.clone() }),
        }
    }
}

/// A wall in the chart of one section; lengths in mm of the chart.
#[derive(Clone, Debug, PartialEq)]
pub struct WallRequest {
    /// Name.
    pub name: String,
    /// Point of the mid line.
    pub center: DVec2,
    /// Unit direction, towards the suction side.
    pub direction: DVec2,
    /// A direction towards the trailing edge, to tell the two faces apart.
    pub downstream: DVec2,
    /// Half the thickness.
    pub half_thickness: f64,
    /// Radius of the fillets in the chamber concerned.
    pub fillet: f64,
}

/// What a chamber is made from.
#[derive(Clone, Debug)]
pub struct RingRequest<'a> {
    /// The offset outline.
    pub outline: &'a Outline,
    /// Camber of the offset outline.
    pub camber: &'a Camber,
    /// Front closure.
    pub front: ClosureKind,
    /// Back closure.
    pub back: ClosureKind,
}

/// The eight segments of a chamber's section, closed, in the direction of u.
#[derive(Clone, Debug)]
pub struct ChamberRing {
    /// Segments in the order of [`SEGMENTS`].
    pub segments: [Segment; SEGMENTS],
}

/// Builds a chamber's ring.
///
/// # Errors
/// A [`Refusal`] where the geometry does not exist.
pub fn chamber_ring(request: &RingRequest<'_>) -> Result<ChamberRing, Refusal> {
    let RingRequest { outline, camber, front, back } = request;
    ring(outline, camber, front, back).map_err(|refusal| with_greatest_fillet(request, refusal))
}

/// Least factor on the radii that is tried for a chamber that cannot be built.
const LEAST_FACTOR: f64 = 1e-3;
/// Accuracy of the greatest factor, relative.
const FACTOR_ACCURACY: f64 = 1e-9;

/// The refusal, or, where the chamber could be built with smaller radii, the greatest that fit: by bisection on a
/// factor for all of them with the same construction, as only refusals pay for it.
fn with_greatest_fillet(request: &RingRequest<'_>, refusal: Refusal) -> Refusal {
    let RingRequest { outline, camber, front, back } = request;
    let named = match &refusal {
        Refusal::FilletTooLarge { wall, .. } | Refusal::WallOutside { wall, .. } => Some(wall),
        Refusal::ChamberTooShort { .. } => None,
        _ => return refusal,
    };
    let walls = [front, back].into_iter().filter_map(|kind| match kind {
        ClosureKind::Wall(wall) => Some(wall),
        ClosureKind::Natural { .. } | ClosureKind::Rounded { .. } => None,
    });
    let mut candidates = walls.filter(|wall| named.is_none_or(|name| *name == wall.name));
    let Some(wall) = candidates.next() else { return refusal };
    let builds = |factor: f64| {
        ring(outline, camber, &front.with_radii_times(factor), &back.with_radii_times(factor)).is_ok()
    };
    let (mut low, mut high) = (0.5, 1.0);
    while !builds(low) {
        (low, high) = (0.5 * low, low);
        if low < LEAST_FACTOR {
            // Not the fillets: the two sides have crossed already where the wall stands.
            return match refusal {
                Refusal::FilletTooLarge { wall: name, .. } => {
                    Refusal::WallOutside { past: past_camber(camber, wall.center), wall: name }
                }
                other => other,
            };
        }
    }
    while high - low > FACTOR_ACCURACY * low {
        let middle = 0.5 * (low + high);
        *(if builds(middle) { &mut low } else { &mut high }) = middle;
    }
    Refusal::FilletTooLarge { wall: wall.name.clone(), radius: wall.fillet, greatest: wall.fillet * low }
}

fn ring(
    outline: &Outline,
    camber: &Camber,
    front: &ClosureKind,
    back: &ClosureKind,
) -> Result<ChamberRing, Refusal> {
    let ends = [front.describe(End::Front), back.describe(End::Back)];
    let front = closure(outline, camber, front, End::Front)?;
    let back = closure(outline, camber, back, End::Back)?;
    let speed = |u: f64| outline.frame(u).speed;
    let lengths = [
        (back.suction - front.suction) * speed(front.suction),
        (front.pressure - back.pressure) * speed(front.pressure),
    ];
    let length = lengths[0].min(lengths[1]);
    if !(length > 0.0) {
        return Err(Refusal::ChamberTooShort { ends, length });
    }
    let [b0, b1, b2] = back.segments;
    let [f0, f1, f2] = front.segments;
    let suction = Segment::Side { from: front.suction, to: back.suction };
    let pressure = Segment::Side { from: back.pressure, to: front.pressure };
    Ok(ChamberRing { segments: [suction, b0, b1, b2, pressure, f0, f1, f2] })
}

impl Camber {
    /// Camber of an outline: the outer profile's, or an offset's.
    ///
    /// `nose` is the parameter of the foremost point, `leading_edge` the two ends of the leading edge (pressure side,
    /// suction side). Marching ends where the contacts are about to merge: where a circle comes near to osculating a
    /// side, as on a circular nose, where its normals nearly coincide, or where a contact comes within a third of the
    /// leading edge's end to the nose; and where the radius falls below `least_radius` at (front, back).
    ///
    /// # Errors
    /// [`Refusal::NoInscribedCircle`]; [`Refusal::Hump`] where a circle comes near to osculating a side between the
    /// edges.
    pub fn of(
        outline: &Outline,
        nose: f64,
        leading_edge: (f64, f64),
        least_radius: (f64, f64),
        step: f64,
    ) -> Result<Self, Refusal> {
        let (start, end) = outline.domain();
        let limits = MarchLimits {
            front: (
                nose + (leading_edge.1 - nose).max(0.0) / 3.0,
                nose + (leading_edge.0 - nose).min(0.0) / 3.0,
            ),
            back: (end, start),
            front_radius: least_radius.0,
            back_radius: least_radius.1,
            step,
            tips: [nose, start, end].map(|u| outline.frame(u).point),
        };
        Self::within(outline, nose, &limits)
    }
}
