//! The colors of the editor in its themes. A color is named by its role; which one that is depends on the theme in use
//! on this thread, the one that shows the window.

use std::cell::Cell;
use std::ops::Deref;

use egui::Color32;

/// A set of colors.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ColorTheme {
    /// Light text on a dark background.
    #[default]
    Dark,
    /// Dark text on a light background.
    Light,
}

impl ColorTheme {
    /// Every theme.
    pub const ALL: [Self; 2] = [Self::Dark, Self::Light];

    /// Display name; also its name in the preferences.
    pub fn label(self) -> &'static str {
        match self {
            Self::Dark => "Dark",
            Self::Light => "Light",
        }
    }

    /// The theme of this name; the first if there is none.
    pub fn named(name: &str) -> Self {
        Self::ALL.into_iter().find(|theme| theme.label() == name).unwrap_or_default()
    }

    /// The theme in use on this thread.
    pub fn current() -> Self {
        CURRENT.get()
    }

    /// Puts it to use on this thread.
    pub fn make_current(self) {
        CURRENT.set(self);
    }
}

thread_local! {
    static CURRENT: Cell<ColorTheme> = const { Cell::new(ColorTheme::Dark) };
}

/// A color by its role.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ThemeColor(usize);

impl ThemeColor {
    /// The color in a theme.
    pub fn of(self, theme: ColorTheme) -> Color32 {
        COLORS[theme as usize][self.0]
    }
}

impl Deref for ThemeColor {
    type Target = Color32;

    fn deref(&self) -> &Color32 {
        &COLORS[CURRENT.get() as usize][self.0]
    }
}

impl From<ThemeColor> for Color32 {
    fn from(color: ThemeColor) -> Self {
        *color
    }
}

/// Makes the colors from a table of roles, each with its dark and its light color.
macro_rules! palette {
    ($($(#[$help:meta])* $name:ident = $dark:expr, $light:expr;)*) => {
        /// The places of the roles in the tables.
        #[allow(non_camel_case_types, clippy::upper_case_acronyms)]
        enum Role { $($name,)* COUNT }

        $($(#[$help])* pub const $name: ThemeColor = ThemeColor(Role::$name as usize);)*

        static COLORS: [[Color32; Role::COUNT as usize]; 2] = [[$(rgb($dark)),*], [$(rgb($light)),*]];
    };
}

const fn rgb(hex: u32) -> Color32 {
    let [_, red, green, blue] = hex.to_be_bytes();
    Color32::from_rgb(red, green, blue)
}

palette! {
    /// The accent color: selection, focus, the primary button.
    ACCENT = 0x6ea8fe, 0x1f5fc8;
    /// Text on the accent color.
    ON_ACCENT = 0x000000, 0xffffff;
    /// Background of selected rows.
    SELECTED = 0x2a4268, 0xcbdcf7;
    /// Background of panels.
    PANEL = 0x1b1d22, 0xeff0f3;
    /// Background of cards in panels.
    CARD = 0x22252b, 0xfafafc;
    /// Background of the bars at the top and the bottom.
    BAR = 0x16181c, 0xe2e4e9;
    /// Background of windows and menus.
    WINDOW = 0x24272e, 0xfcfcfd;
    /// Background of what floats over the picture.
    FLOATING = 0x14161a, 0xf4f5f7;
    /// Background of fields for text and numbers.
    FIELD = 0x2e323a, 0xd6dae2;
    /// The same with the pointer over it.
    FIELD_HOVERED = 0x3a3f49, 0xcacfd9;
    /// The same while it is pressed.
    FIELD_PRESSED = 0x424854, 0xbec4d0;
    /// Borders of cards and windows.
    BORDER = 0x3a3e48, 0xc6cad3;
    /// Thin lines between areas.
    LINE = 0x0e0f12, 0xc3c7cf;
    /// Background of text that is being typed.
    DEEP = 0x121418, 0xffffff;
    /// Every second row.
    STRIPE = 0x1f2127, 0xe8eaee;
    /// Titles, and text under the pointer.
    STRONG = 0xffffff, 0x0b0d10;
    /// Normal text.
    TEXT = 0xd4d8df, 0x23272e;
    /// Labels and hints.
    WEAK = 0x969ca8, 0x535a67;
    /// Text of what is hidden or unused, and controls at rest.
    FAINT = 0x8a909d, 0x636a77;
    /// Switches of rows without the pointer.
    RESTING = 0x454a55, 0xa4a9b4;
    /// Parameters that change with time.
    ANIMATED = 0x7ec888, 0x1c7434;
    /// Keys at the moment that is shown, and selected keys.
    KEYED = 0xf4c860, 0x805800;
    /// Errors.
    ERROR = 0xf07068, 0xb3261e;
    /// Warnings.
    WARNING = 0xe8b25c, 0x855000;
    /// Success.
    SUCCESS = 0x7ec888, 0x1c7434;
    /// Groups.
    GROUP = 0xe2b86e, 0x855000;
    /// Objects.
    OBJECT = 0x7eb6e0, 0x1a639c;
    /// Subtracted nodes.
    NEGATIVE = 0xe88076, 0xad3128;
    /// Lights.
    LIGHT = 0xf4d678, 0x7a5c00;
    /// Cameras.
    CAMERA = 0xa896e8, 0x6448b8;
    /// Meshes.
    MESH = 0x7ec8a0, 0x0d7049;
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Relative luminance as the Web Content Accessibility Guidelines 2.2 define it.
    fn luminance(color: Color32) -> f64 {
        let linear = |channel: u8| {
            let value = f64::from(channel) / 255.0;
            if value <= 0.04045 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
        };
        0.2126 * linear(color.r()) + 0.7152 * linear(color.g()) + 0.0722 * linear(color.b())
    }

    fn contrast(a: Color32, b: Color32) -> f64 {
        let (a, b) = (luminance(a), luminance(b));
        (a.max(b) + 0.05) / (a.min(b) + 0.05)
    }

    /// The guidelines ask for 4.5 for text.
    const LEAST: f64 = 4.5;

    #[test]
    fn text_has_contrast_in_every_theme() {
        let everywhere = [PANEL, CARD, BAR, WINDOW, FLOATING, STRIPE];
        let fields = [FIELD, SELECTED, DEEP];
        let mut poor = Vec::new();
        for theme in ColorTheme::ALL {
            let mut check = |name: &str, text: ThemeColor, grounds: &[ThemeColor]| {
                for ground in grounds {
                    let ratio = contrast(text.of(theme), ground.of(theme));
                    if ratio < LEAST {
                        poor.push(format!("{} {name} on {ground:?}: {ratio:.2}", theme.label()));
                    }
                }
            };
            for (name, text) in [("strong", STRONG), ("text", TEXT), ("weak", WEAK), ("accent", ACCENT)] {
                check(name, text, &everywhere);
            }
            for (name, text) in [("strong", STRONG), ("text", TEXT)] {
                check(name, text, &fields);
                check(name, text, &[FIELD_HOVERED, FIELD_PRESSED]);
            }
            check("weak", WEAK, &[FIELD, DEEP]);
            check("faint", FAINT, &[PANEL, WINDOW, CARD]);
            let signs = [ERROR, WARNING, SUCCESS, ANIMATED, KEYED, GROUP, OBJECT, NEGATIVE, LIGHT, CAMERA, MESH];
            for (index, sign) in signs.into_iter().enumerate() {
                check(&format!("sign {index}"), sign, &[PANEL, CARD, BAR, WINDOW]);
            }
            check("on accent", ON_ACCENT, &[ACCENT]);
        }
        assert!(poor.is_empty(), "{}", poor.join("\n"));
    }

    #[test]
    fn the_measure_of_contrast_is_that_of_the_guidelines() {
        assert!((contrast(Color32::BLACK, Color32::WHITE) - 21.0).abs() < 1e-9);
        // #777 on white is the known example that just fails.
        let fails = contrast(Color32::from_gray(0x77), Color32::WHITE);
        assert!((fails - 4.48).abs() < 0.01 && fails < LEAST, "{fails}");
    }

    #[test]
    fn a_thread_has_a_theme_of_its_own() {
        ColorTheme::Light.make_current();
        let light = *TEXT;
        let other = std::thread::spawn(|| *TEXT).join().expect("no panic");
        ColorTheme::Dark.make_current();
        assert_eq!((light, other), (TEXT.of(ColorTheme::Light), TEXT.of(ColorTheme::Dark)));
    }
}
