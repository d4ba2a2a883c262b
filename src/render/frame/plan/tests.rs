//! Tests: plans cover every pixel, and planning fails if a frame would be too long.

use super::*;

/// The light of a scene without lights.
const LIGHT: PixelLight = PixelLight { lights: 2, tiled: false, shadows: 0.0 };

fn shown(view: &SampleView, size: [u32; 2]) -> PlannedView<'_> {
    PlannedView { view, size, traced: TracedParts::default() }
}

#[test]
fn parts_cover_every_pixel_once_and_stay_small() {
    let rect = Rect { origin: [16, 8], end: [301, 177] };
    for (per_pixel, most) in [(1.0, 1e12), (1.0, 5000.0), (100.0, 5000.0), (1e9, 1.0)] {
        let mut covered = vec![0; 301 * 177];
        let mut parts = 0;
        rect.cut(per_pixel, most, |r| {
            parts += 1;
            let limit = most.max(per_pixel * f64::from(TILE * TILE));
            assert!(r.pixels() * per_pixel <= limit, "{r:?}");
            for y in r.origin[1]..r.end[1] {
                for x in r.origin[0]..r.end[0] {
                    covered[(y * 301 + x) as usize] += 1;
                }
            }
        });
        assert_eq!(rect.parts(per_pixel, most), parts);
        for y in 0..177 {
            for x in 0..301 {
                let inside = x >= 16 && y >= 8;
                assert_eq!(covered[y * 301 + x], i32::from(inside));
            }
        }
    }
}

#[test]
fn what_is_traced_again_has_more_relaunches_of_the_components_that_are_meant() {
    let flat = isolith_field::flatten(&isolith_gallery::random(32, 1), 0.0).expect("within the limits");
    let camera = flat.default_camera(&[], 1.0);
    let slow = EvaluationCost { straight: false, iterations: MAX_ITERATIONS / 2, leaves: 8.0 };
    let evaluations = vec![slow; flat.components.len()];
    let plan =
        plan(&flat, shown(&camera.into(), [64, 64]), &evaluations, LIGHT, &CostModel::new(true), Room::UNLIMITED)
            .expect("room for all");
    let of = |dispatches: &[Dispatch], pass: Pass| dispatches.iter().filter(|dispatch| dispatch.pass == pass).count();
    let again = plan.again(|component| component == 2, 8);
    let meant: Vec<Dispatch> =
        plan.dispatches.iter().filter(|dispatch| dispatch.params.component == 2).copied().collect();
    assert!(again.iter().all(|dispatch| dispatch.params.component == 2 || dispatch.pass == Pass::Shade));
    assert_eq!(of(&again, Pass::Shade), of(&plan.dispatches, Pass::Shade));
    assert_eq!(of(&again, Pass::Surface), of(&meant, Pass::Surface));
    assert_eq!(of(&again, Pass::Cone), of(&meant, Pass::Cone));
    assert_eq!(of(&again, Pass::Trace), 8 * of(&meant, Pass::Trace));
    let mut last = again.iter().filter(|dispatch| dispatch.pass == Pass::Trace && dispatch.params.last_relaunch == 1);
    let relaunches = meant.iter().map(|dispatch| dispatch.params.relaunch + 1).max().expect("it is seen");
    assert!(relaunches > 1_000 && last.all(|dispatch| dispatch.params.relaunch + 1 == 8 * relaunches));
    assert!(again.iter().all(|dispatch| (dispatch.params.compacted == 1) == (dispatch.params.relaunch > 0)));
    assert!(plan.again(|_| false, 8).iter().all(|dispatch| dispatch.pass == Pass::Shade));
}

#[test]
fn more_dispatches_than_there_is_room_for_are_refused_with_the_component() {
    let flat = isolith_field::flatten(&isolith_gallery::random(32, 1), 0.0).expect("within the limits");
    let camera = flat.default_camera(&[], 1.0);
    let cheap = EvaluationCost { straight: true, iterations: 10, leaves: 8.0 };
    // A dispatch has room for only a few steps of the third component.
    let mut evaluations = vec![cheap; flat.components.len()];
    evaluations[2].iterations = MAX_ITERATIONS / 4;
    let planned =
        |room| plan(&flat, shown(&camera.into(), [640, 480]), &evaluations, LIGHT, &CostModel::new(true), room);
    let whole = planned(Room::UNLIMITED).expect("room for all");
    let (count, subtiles) = (whole.dispatches.len(), u64::from(whole.subtiles));
    assert!(count > 1_000, "{count}");
    let just_enough = Room { dispatches: count, subtiles };
    assert_eq!(planned(just_enough).expect("just enough room").dispatches.len(), count);
    let error = planned(Room { dispatches: count - 1, ..just_enough }).expect_err("too many dispatches");
    assert_eq!(error, TooMuch::Pieces { component: 2 });
    // The component that covers the largest area has the longest lists.
    let of_component = |index: usize| {
        let cones = whole.dispatches.iter().filter(|p| p.pass == Pass::Cone && p.params.component as usize == index);
        cones.map(|dispatch| dispatch.tiles().iter().product::<u32>() * SUBTILES * SUBTILES).sum::<u32>()
    };
    let error = planned(Room { subtiles: subtiles - 1, ..just_enough }).expect_err("too many subtiles");
    let TooMuch::Subtiles { component, subtiles: needed } = error else { panic!("{error:?}") };
    assert_eq!(needed, subtiles);
    let longest = (0..flat.components.len()).map(of_component).max().expect("there are some");
    assert_eq!(of_component(component), longest);
}

#[test]
fn only_pictures_with_shadows_have_dispatches_for_them_two_for_each_part() {
    let flat = isolith_field::flatten(&isolith_gallery::random(8, 1), 0.0).expect("within the limits");
    let camera = flat.default_camera(&[], 1.0);
    let cheap = EvaluationCost { straight: true, iterations: 10, leaves: 8.0 };
    let evaluations = vec![cheap; flat.components.len()];
    let of = |shadows: f64| {
        let model = CostModel::new(true);
        let plan = plan(
            &flat,
            shown(&camera.into(), [320, 200]),
            &evaluations,
            PixelLight { shadows, ..LIGHT },
            &model,
            Room::UNLIMITED,
        )
        .expect("room");
        let shadows = plan.dispatches.into_iter().filter(|dispatch| dispatch.pass == Pass::Shadow);
        shadows.map(|dispatch| dispatch.params).collect::<Vec<_>>()
    };
    assert!(of(0.0).is_empty());
    let parts = of(1e4);
    assert!(parts.len() > 2);
    for pair in parts.chunks(2) {
        assert_eq!((pair[0].origin, pair[0].end), (pair[1].origin, pair[1].end));
        assert_eq!((pair[0].relaunch, pair[1].relaunch), (0, 1));
    }
}

#[test]
fn parts_with_fewer_rays_choose_them_twice() {
    let mut flat = isolith_field::flatten(&isolith_gallery::random(32, 1), 0.0).expect("within the limits");
    flat.components[1].march.resolution = MarchResolution::Quarter;
    let camera = flat.default_camera(&[], 1.0);
    let slow = EvaluationCost { straight: false, iterations: MAX_ITERATIONS / 1_000, leaves: 8.0 };
    let evaluations = vec![slow; flat.components.len()];
    let planned = |room| plan(&flat, shown(&camera.into(), [64, 64]), &evaluations, LIGHT, &CostModel::new(true), room);
    let whole = planned(Room::UNLIMITED).expect("room for all");
    let room = |dispatches| Room { dispatches, ..Room::UNLIMITED };
    assert!(planned(room(whole.dispatches.len())).is_ok() && planned(room(whole.dispatches.len() - 1)).is_err());
    let marches: Vec<&Dispatch> = whole.dispatches.iter().filter(|one| one.pass != Pass::Surface).collect();
    let (mut few, mut all) = (0, 0);
    for of_list in marches.chunk_by(|a, b| a.params.list == b.params.list && a.params.component == b.params.component) {
        let [cone, rest @ ..] = of_list else { continue };
        if cone.pass != Pass::Cone {
            continue;
        }
        let chosen: Vec<u32> =
            rest.iter().filter(|one| one.pass == Pass::Resolution).map(|one| one.params.relaunch).collect();
        let last: Vec<usize> = (0..rest.len()).filter(|at| rest[*at].params.last_relaunch == 1).collect();
        assert_eq!(last, [rest.len() - 1]);
        if cone.params.component == 1 {
            assert_eq!(chosen, [0, 1]);
            let (first, second) = rest.split_at(rest.len() / 2);
            assert!(first.len() == second.len() && first[0].pass == second[0].pass && first.len() > 2);
            assert!(first[1..].iter().chain(&second[1..]).all(|one| one.params.compacted == 1));
            few += 1;
        } else {
            assert!(chosen.is_empty() && rest[0].params.compacted == 0);
            all += 1;
        }
    }
    assert!(few > 0 && all > 0, "{few}, {all}");
}
