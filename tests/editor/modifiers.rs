//! The modifier card: add each kind, change its values, reorder, disable, remove; refused files.

use egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use isolith::editor::Editor;
use isolith::scene::{MAX_MODIFIERS, ModifierKind, ModifierSlot, NodeId, ParamValue};

use super::attachments::choose;
use super::{open_tall, scene, undo_all};

/// The editor with the torus selected, tall enough for all of its cards.
fn with_ring() -> (Harness<'static, Editor>, NodeId) {
    let (scene, [.., ring]) = scene();
    let mut harness = open_tall(scene);
    harness.state_mut().document_mut().select(vec![ring]);
    harness.run();
    (harness, ring)
}

fn modifiers(harness: &Harness<'_, Editor>, id: NodeId) -> Vec<ModifierSlot> {
    harness.state().document().scene().node(id).unwrap().modifiers.clone()
}

fn kinds(harness: &Harness<'_, Editor>, id: NodeId) -> Vec<ModifierKind> {
    modifiers(harness, id).iter().map(|slot| slot.modifier.kind()).collect()
}

/// The last widget of this name: the modifier card is below the others.
fn widget<'h>(harness: &'h Harness<'_, Editor>, name: &'h str, role: Role) -> egui_kittest::Node<'h> {
    let found = harness.get_all_by_label(name).rfind(|n| n.accesskit_node().role() == role);
    found.unwrap_or_else(|| panic!("no {role:?} {name}"))
}

fn click(harness: &mut Harness<'_, Editor>, name: &str, role: Role) {
    widget(harness, name, role).click();
    harness.run();
}

fn add(harness: &mut Harness<'_, Editor>, kind: ModifierKind) {
    harness.get_by_label_contains("Add modifier").click();
    harness.run();
    click(harness, kind.label(), Role::Button);
}

/// `carve_from` → `Carve from`.
fn field_name(name: &str) -> String {
    let spaced = name.replace('_', " ");
    format!("{}{}", spaced[..1].to_uppercase(), &spaced[1..])
}

/// Changes a value in the inspector. Returns the expected result, or `None` for a file.
fn change(harness: &mut Harness<'_, Editor>, name: &str, value: &ParamValue) -> Option<ParamValue> {
    let mut number = |name: &str, v: f64| {
        widget(harness, name, Role::SpinButton).set_value_accesskit(v);
        harness.run();
        v
    };
    Some(match value {
        ParamValue::Scalar(v) => ParamValue::Scalar(number(name, v * 0.5 + 0.125)),
        ParamValue::Count(n) => ParamValue::Count(number(name, f64::from(n + 1)) as u32),
        ParamValue::Vector(v) => {
            let y = number(&format!("{name} Y"), v.y * 0.5 + 0.125);
            ParamValue::Vector(glam::DVec3::new(v.x, y, v.z))
        }
        ParamValue::Counts([x, y, z]) => {
            let changed = number(&format!("{name} Z"), f64::from(z + 2));
            ParamValue::Counts([*x, *y, changed as u32])
        }
        ParamValue::Flag(on) => {
            click(harness, name, Role::CheckBox);
            ParamValue::Flag(!on)
        }
        ParamValue::Flags([x, y, z]) => {
            click(harness, &format!("{name} Y"), Role::CheckBox);
            ParamValue::Flags([*x, !y, *z])
        }
        ParamValue::Choice(_) => {
            click(harness, name, Role::ComboBox);
            click(harness, "Z", Role::Button);
            ParamValue::Choice("z")
        }
        ParamValue::File(_) => return None,
        other => unreachable!("no modifier has {other:?}"),
    })
}

#[test]
fn every_kind_is_added_and_each_of_its_values_changed() {
    for &kind in ModifierKind::ALL {
        let (mut harness, ring) = with_ring();
        let before = harness.state().document().scene().clone();
        add(&mut harness, kind);
        assert_eq!(modifiers(&harness, ring), [kind.default_modifier().into()]);
        let mut steps = 1;
        for (i, param) in kind.params().iter().enumerate() {
            let value = kind.default_modifier().values().swap_remove(i);
            let Some(expected) = change(&mut harness, &field_name(param.name), &value) else { continue };
            let found = modifiers(&harness, ring)[0].modifier.values();
            assert_eq!(found[i], expected, "{kind:?}.{}", param.name);
            assert_ne!(found[i], value, "{kind:?}.{}", param.name);
            steps += 1;
        }
        assert_eq!(undo_all(&mut harness), steps, "{kind:?}");
        assert_eq!(*harness.state().document().scene(), before, "{kind:?}");
    }
}

#[test]
fn modifiers_are_reordered_switched_off_and_removed() {
    use ModifierKind::{Round, Twist, Waves};
    let (mut harness, ring) = with_ring();
    let before = harness.state().document().scene().clone();
    for kind in [Twist, Round, Waves] {
        add(&mut harness, kind);
    }
    assert_eq!(kinds(&harness, ring), [Twist, Round, Waves]);
    let press = |harness: &mut Harness<'_, Editor>, name: &str, at: usize| {
        harness.get_all_by_label(name).nth(at).unwrap().click();
        harness.run();
    };
    press(&mut harness, "Move down", 0);
    assert_eq!(kinds(&harness, ring), [Round, Twist, Waves]);
    press(&mut harness, "Move up", 2);
    assert_eq!(kinds(&harness, ring), [Round, Waves, Twist]);
    // The first cannot move up, nor the last down.
    press(&mut harness, "Move up", 0);
    press(&mut harness, "Move down", 2);
    assert_eq!(kinds(&harness, ring), [Round, Waves, Twist]);
    click(&mut harness, Waves.label(), Role::CheckBox);
    assert_eq!(modifiers(&harness, ring).iter().map(|slot| slot.enabled).collect::<Vec<_>>(), [true, false, true]);
    assert!(harness.state().flat().nodes.iter().all(|node| node.modifier() != Some(Waves)));
    press(&mut harness, "Remove the modifier", 0);
    assert_eq!(kinds(&harness, ring), [Waves, Twist]);
    assert_eq!(undo_all(&mut harness), 7);
    assert_eq!(*harness.state().document().scene(), before);
}

#[test]
fn there_is_an_end_to_adding() {
    let (mut harness, ring) = with_ring();
    let mut node = harness.state().document().scene().node(ring).unwrap().as_ref().clone();
    node.modifiers = vec![ModifierKind::Round.default_modifier().into(); MAX_MODIFIERS];
    harness.state_mut().document_mut().apply(isolith::document::Edit::Replace(node)).unwrap();
    harness.run();
    assert!(harness.query_by_label_contains("Add modifier").is_none());
    assert!(harness.query_by_label_contains("are the most that a node can have").is_some());
}

#[test]
fn the_image_of_a_displacement_is_chosen_refused_and_done_without() {
    let folder = tempfile::tempdir().unwrap();
    let [image, text] = ["bark.png", "notes.txt"].map(|name| folder.path().join(name));
    image::GrayImage::from_fn(8, 8, |x, y| image::Luma([(16 * x + y) as u8])).save(&image).unwrap();
    std::fs::write(&text, "no image").unwrap();
    let (mut harness, ring) = with_ring();
    add(&mut harness, ModifierKind::Twist);
    add(&mut harness, ModifierKind::Displacement);
    let name = |harness: &Harness<'_, Editor>| {
        let ParamValue::File(file) = modifiers(harness, ring)[1].modifier.values().swap_remove(0) else { panic!() };
        file.name().map(str::to_owned)
    };
    let displaces = |harness: &Harness<'_, Editor>| {
        harness.state().flat().nodes.iter().any(|node| node.modifier() == Some(ModifierKind::Displacement))
    };
    assert!(name(&harness).is_none() && !displaces(&harness));
    choose(&mut harness, "Image: No file", &text);
    let message = harness.state().messages().last().unwrap().text.clone();
    let place = format!("Ring {ring}: Displace (image): image: ");
    assert!(message.starts_with(&format!("{place}\"notes.txt\" must be a PNG, JPEG or EXR image")), "{message}");
    assert!(name(&harness).is_none());
    choose(&mut harness, "Image: No file", &image);
    assert_eq!(name(&harness).as_deref(), Some("bark.png"));
    assert!(displaces(&harness));
    choose(&mut harness, "Image: bark.png", &folder.path().join("none.png"));
    let message = harness.state().messages().last().unwrap().text.clone();
    assert!(message.starts_with(&place) && message.contains("none.png"), "{message}");
    assert_eq!(name(&harness).as_deref(), Some("bark.png"));
    harness.get_by_label("Image: none").click();
    harness.run();
    assert!(name(&harness).is_none() && !displaces(&harness));
    assert_eq!(undo_all(&mut harness), 4);
}
