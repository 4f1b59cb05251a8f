//! Unsafe delays as other programs compute them, written here after their formulas. Both go back to Walker and Sturtevant
//! (arXiv 1908.09707, Section 5.1): positions are a conic in time and delay, and the extreme delays are those of the conic.
//! docs/theory/equations.md goes through them; `tests/delays_published.rs` shows where they are wrong.

/// A straight edge.
pub type Line = [[f64; 2]; 2];

fn minus([a, b]: [f64; 2], [c, d]: [f64; 2]) -> [f64; 2] {
    [a - c, b - d]
}

fn dot([a, b]: [f64; 2], [c, d]: [f64; 2]) -> f64 {
    a * c + b * d
}

fn velocity([from, to]: Line) -> ([f64; 2], f64) {
    let way = minus(to, from);
    let length = dot(way, way).sqrt();
    (way.map(|x| x / length), length)
}

/// The extreme delays of the whole conic, at speed 1, as in the program of the report's first author (HOG2, `getForbiddenInterval`): the
/// edges have no ends. Delays are those of `a`.
pub fn whole_conic(a: Line, b: Line, reach: f64) -> Option<[f64; 2]> {
    let ((va, _), (vb, _)) = (velocity(a), velocity(b));
    let (dab, dv) = (minus(b[0], a[0]), minus(vb, va));
    // Distance of the start of `b` from the line of `a`.
    let aside = dab[0] * va[1] - dab[1] * va[0];
    let past = (reach * reach - aside * aside).sqrt();
    if dv[0].abs() < 1e-8 && dv[1].abs() < 1e-8 {
        let along = (dot(dab, dab) - aside * aside).sqrt();
        return (aside * aside < reach * reach).then_some([along - past, along + past]);
    }
    if va == [-vb[0], -vb[1]] {
        let along = (dot(dab, dab) - aside * aside).sqrt();
        return (aside * aside < reach * reach).then_some([f64::NEG_INFINITY, along + past]);
    }
    let (qa, qb, qc) = (dot(dv, dv), 2.0 * (dot(va, va) - dot(va, vb)), dot(va, va));
    let (qd, qe, qf) = (2.0 * dot(dab, dv), -2.0 * dot(dab, va), dot(dab, dab) - reach * reach);
    let bent = 4.0 * qa * qc - qb * qb;
    let g = qb * qd - 2.0 * qa * qe;
    let half = (4.0 * g * g + 4.0 * bent * (qd * qd - 4.0 * qa * qf)).sqrt() / (2.0 * bent);
    Some([-g / bent - half, -g / bent + half])
}

/// The delays of `b` after `a`, at speed 1, as in the program of CPLP (`edge_edge_unsafe_interval`): the conic cut by what the
/// edges allow.
pub fn cut_conic(a: Line, b: Line, reach: f64) -> Option<[f64; 2]> {
    let ((va, da), (vb, db)) = (velocity(a), velocity(b));
    let (dv, w) = (minus(va, vb), minus(a[0], b[0]));
    let (qa, qb, qc) = (dot(dv, dv), 2.0 * dot(vb, dv), dot(vb, vb));
    let (qd, qe, qf) = (2.0 * dot(w, dv), 2.0 * dot(vb, w), dot(w, w) - reach * reach);
    // Of x² + p x + q.
    let roots = |p: f64, q: f64| {
        let under = p * p / 4.0 - q;
        (under >= 0.0).then(|| [-p / 2.0 - under.sqrt(), -p / 2.0 + under.sqrt()])
    };
    if dv[0].hypot(dv[1]) < 1e-6 {
        // As printed there: E has the wrong sign.
        let [lo, hi] = roots(-qe / qc, qf / qc)?;
        return (lo <= da && -db <= hi).then(|| [lo.max(-db), hi.min(da)]);
    }
    let mut points = Vec::new();
    let mut side = |p: f64, q: f64, point: &dyn Fn(f64) -> (f64, f64), within: [f64; 2], of: fn((f64, f64)) -> f64| {
        for root in roots(p, q).into_iter().flatten() {
            let place = point(root);
            if (within[0]..=within[1]).contains(&of(place)) {
                points.push(place);
            }
        }
    };
    let (time, delay) = (|place: (f64, f64)| place.0, |place: (f64, f64)| place.1);
    side(qe / qc, qf / qc, &|x| (0.0, x), [-db, 0.0], delay);
    side((qb * da + qe) / qc, (qa * da * da + qd * da + qf) / qc, &|x| (da, x), [da - db, da], delay);
    let all = qa + qb + qc;
    side((qd + qe) / all, qf / all, &|x| (x, x), [0.0, da], time);
    let (p, q) = ((2.0 * qa * db + qb * db + qd + qe) / all, (qa * db * db + qd * db + qf) / all);
    side(p, q, &|x| (x + db, x), [0.0, da], time);
    let bent = 4.0 * qa * qc - qb * qb;
    if bent > 0.0 {
        let centre = (qb * qd - 2.0 * qa * qe) / bent;
        let under = (2.0 * qb * qd - 4.0 * qa * qe).powi(2) + 4.0 * bent * (qd * qd - 4.0 * qa * qf);
        let half = under.sqrt() / (2.0 * bent);
        for delay in [centre - half, centre + half] {
            let time = (-qb * delay - qd) / (2.0 * qa);
            if (0.0..=da).contains(&time) && (time - db..=time).contains(&delay) {
                points.push((time, delay));
            }
        }
    }
    for (t, x) in [(0.0, 0.0), (da, da), (da, da - db), (0.0, -db)] {
        if qa * t * t + qb * t * x + qc * x * x + qd * t + qe * x + qf <= 0.0 {
            points.push((t, x));
        }
    }
    let delays = points.iter().map(|point| point.1);
    let lo = delays.clone().reduce(f64::min)?;
    Some([lo, delays.reduce(f64::max)?])
}
