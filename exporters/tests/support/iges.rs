//! A small reader of IGES files, strict about their columns.

use coolinggen_nurbs::{Curve, Homogeneous, Knots, RationalCurve, RationalSurface, Surface};
use glam::{DVec2, DVec3};

/// An entity: what the directory says, and its parameters behind the type number.
#[derive(Clone, Debug)]
pub struct Entity {
    pub kind: usize,
    pub form: usize,
    pub level: usize,
    pub color: i64,
    pub status: String,
    pub label: String,
    pub parameters: Vec<String>,
}

impl Entity {
    pub fn integer(&self, i: usize) -> usize {
        self.parameters[i].parse().unwrap()
    }

    pub fn real(&self, i: usize) -> f64 {
        assert!(self.parameters[i].contains('.'), "{} has no decimal point", self.parameters[i]);
        self.parameters[i].parse().unwrap()
    }
}

/// A file: the global parameters and the entities in their order.
pub struct File {
    pub global: String,
    pub entities: Vec<Entity>,
}

impl File {
    /// Reads a file; panics where a line, a number or a count is not as the format has it.
    pub fn read(text: &str) -> Self {
        let mut sections: Vec<(char, Vec<&str>)> = Vec::new();
        for line in text.lines() {
            assert!(line.len() == 80 && line.is_ascii(), "{line}");
            let letter = line.as_bytes()[72] as char;
            if sections.last().is_none_or(|s| s.0 != letter) {
                sections.push((letter, Vec::new()));
            }
            let lines = &mut sections.last_mut().unwrap().1;
            lines.push(&line[..72]);
            assert_eq!(line[73..].parse(), Ok(lines.len()), "{line}");
        }
        assert_eq!(sections.iter().map(|s| s.0).collect::<String>(), "SGDPT");
        let lines = |i: usize| &sections[i].1;
        let counts: String =
            sections[..4].iter().map(|(letter, lines)| format!("{letter}{:07}", lines.len())).collect();
        assert_eq!(lines(4)[0].trim_end(), counts);
        let field = |line: &str, i: usize| line[8 * i..8 * (i + 1)].trim().to_owned();
        let number = |line: &str, i: usize| field(line, i).parse::<usize>().unwrap();
        let mut next = 1;
        let directory = lines(2).chunks(2).enumerate().map(|(index, pair)| {
            let (first, second) = (pair[0], pair[1]);
            assert_eq!((number(first, 0), number(first, 1)), (number(second, 0), next));
            let of_entity = &lines(3)[next - 1..next - 1 + number(second, 3)];
            next += of_entity.len();
            let mut record = String::new();
            for line in of_entity {
                assert_eq!(line[64..].trim().parse(), Ok(2 * index + 1), "{line}");
                // No parameter goes over the end of a line: there are no strings.
                assert!(line[..64].trim_end().ends_with([',', ';']), "{line}");
                record.push_str(line[..64].trim_end());
            }
            let record = record.strip_suffix(';').unwrap();
            let mut parameters: Vec<String> = record.split(',').map(str::to_owned).collect();
            assert_eq!(parameters.remove(0).parse(), Ok(number(first, 0)));
            Entity {
                kind: number(first, 0),
                form: number(second, 4),
                level: number(first, 4),
                color: field(second, 2).parse().unwrap(),
                status: field(first, 8),
                label: field(second, 7),
                parameters,
            }
        });
        let entities = directory.collect();
        assert_eq!(next, lines(3).len() + 1);
        Self { global: lines(1).concat(), entities }
    }

    /// The entity that parameter `i` of another points to, which must be of this type.
    pub fn at(&self, from: &Entity, i: usize, kind: usize) -> &Entity {
        let number = from.integer(i);
        assert_eq!(number % 2, 1);
        let found = &self.entities[number / 2];
        assert_eq!(found.kind, kind, "{from:?}");
        found
    }

    pub fn of_kind(&self, kind: usize) -> Vec<&Entity> {
        self.entities.iter().filter(|e| e.kind == kind).collect()
    }

    /// Red, green, blue in percent of an entity.
    pub fn color(&self, of: &Entity) -> [f64; 3] {
        let definition = &self.entities[(-of.color) as usize / 2];
        assert_eq!(definition.kind, 314);
        [0, 1, 2].map(|i| definition.real(i))
    }
}

/// A curve, entity 126.
pub fn curve(e: &Entity) -> RationalCurve<DVec3> {
    assert_eq!(e.kind, 126);
    let (count, degree) = (e.integer(0) + 1, e.integer(1));
    let knots: Vec<f64> = (0..count + degree + 1).map(|i| e.real(6 + i)).collect();
    let weights = 6 + knots.len();
    let points = weights + count;
    let homogeneous = (0..count).map(|i| {
        let p = DVec3::from_array([0, 1, 2].map(|k| e.real(points + 3 * i + k)));
        Homogeneous::new(p, e.real(weights + i))
    });
    let knots = Knots::new(degree, knots).unwrap();
    let end = points + 3 * count;
    assert_eq!((e.real(end), e.real(end + 1)), knots.domain());
    assert_eq!(e.parameters.len(), end + 5);
    let made = Curve::new(knots, homogeneous.collect()).unwrap();
    RationalCurve::from_homogeneous(made).unwrap()
}

/// A surface, entity 128.
pub fn surface(e: &Entity) -> RationalSurface<DVec3> {
    assert_eq!(e.kind, 128);
    let [nu, nv, p, q] = [e.integer(0) + 1, e.integer(1) + 1, e.integer(2), e.integer(3)];
    let knots = |first: usize, count: usize, degree: usize| {
        Knots::new(degree, (first..first + count + degree + 1).map(|i| e.real(i)).collect()).unwrap()
    };
    let (u, v) = (knots(9, nu, p), knots(9 + nu + p + 1, nv, q));
    let weights = 9 + nu + p + 1 + nv + q + 1;
    let points = weights + nu * nv;
    let at = |i: usize, j: usize| {
        let place = j * nu + i;
        let p = DVec3::from_array([0, 1, 2].map(|k| e.real(points + 3 * place + k)));
        Homogeneous::new(p, e.real(weights + place))
    };
    let net = (0..nu).flat_map(|i| (0..nv).map(move |j| (i, j))).map(|(i, j)| at(i, j)).collect();
    assert_eq!(e.parameters.len(), points + 3 * nu * nv + 4);
    RationalSurface::from_homogeneous(Surface::new(u, v, net).unwrap()).unwrap()
}

/// The first two coordinates.
pub fn flat(p: DVec3) -> DVec2 {
    assert_eq!(p.z, 0.0);
    p.truncate()
}
