//! Attachments of any kind.

use super::attachment::{Attachment, Content};
use super::environment_image::EnvironmentImage;
use super::heights::Heights;
use super::texture_image::TextureImage;
use isolith_font::Face;

/// An attachment of any kind, as the value of a parameter.
#[derive(Clone, Debug, PartialEq)]
pub enum Attached {
    /// An image of heights.
    Heights(Attachment<Heights>),
    /// An image of a texture.
    Texture(Attachment<TextureImage>),
    /// A font.
    Font(Attachment<Face>),
    /// An image of everything around the scene.
    Environment(Attachment<EnvironmentImage>),
}

impl Attached {
    /// The file's name.
    pub fn name(&self) -> Option<&str> {
        match self {
            Self::Heights(file) => file.name(),
            Self::Texture(file) => file.name(),
            Self::Font(file) => file.name(),
            Self::Environment(file) => file.name(),
        }
    }

    /// The size of the file in bytes; 0 without a file.
    pub fn size(&self) -> usize {
        match self {
            Self::Heights(file) => file.size(),
            Self::Texture(file) => file.size(),
            Self::Font(file) => file.size(),
            Self::Environment(file) => file.size(),
        }
    }

    /// The file's name, or the name of the default that a shape uses without a file.
    pub fn label(&self) -> &str {
        let without = match self {
            Self::Heights(_) => Heights::WITHOUT,
            Self::Texture(_) => TextureImage::WITHOUT,
            Self::Font(_) => Face::WITHOUT,
            Self::Environment(_) => EnvironmentImage::WITHOUT,
        };
        self.name().unwrap_or(without)
    }

    /// The accepted file name extensions.
    pub fn endings(&self) -> &'static [&'static str] {
        match self {
            Self::Heights(_) => Heights::ENDINGS,
            Self::Texture(_) => TextureImage::ENDINGS,
            Self::Font(_) => Face::ENDINGS,
            Self::Environment(_) => EnvironmentImage::ENDINGS,
        }
    }

    /// The same kind of attachment, without a file.
    pub fn without(&self) -> Self {
        match self {
            Self::Heights(_) => Self::Heights(Attachment::NONE),
            Self::Texture(_) => Self::Texture(Attachment::NONE),
            Self::Font(_) => Self::Font(Attachment::NONE),
            Self::Environment(_) => Self::Environment(Attachment::NONE),
        }
    }

    /// The same kind of attachment with another file. The error says why the file cannot be used.
    pub fn with(&self, name: &str, bytes: Vec<u8>) -> Result<Self, String> {
        Ok(match self {
            Self::Heights(_) => Self::Heights(Attachment::new(name, bytes)?),
            Self::Texture(_) => Self::Texture(Attachment::new(name, bytes)?),
            Self::Font(_) => Self::Font(Attachment::new(name, bytes)?),
            Self::Environment(_) => Self::Environment(Attachment::new(name, bytes)?),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::limits::MAX_ATTACHMENT_BYTES;

    fn font() -> Vec<u8> {
        epaint_default_fonts::HACK_REGULAR.to_vec()
    }

    #[test]
    fn what_is_no_such_file_is_refused_with_a_reason() {
        let font_as_image = Attachment::<Heights>::new("x.png", font()).unwrap_err();
        assert!(font_as_image.starts_with("\"x.png\" must be a PNG, JPEG or EXR image"), "{font_as_image}");
        let half = font()[..2000].to_vec();
        let broken = Attachment::<Face>::new("x.ttf", half).unwrap_err();
        assert!(broken.starts_with("\"x.ttf\" must be a TrueType or OpenType font"), "{broken}");
        let huge = Attachment::<Face>::new("x.ttf", vec![0; MAX_ATTACHMENT_BYTES + 1]).unwrap_err();
        assert!(huge.contains("at most 16 MiB"), "{huge}");
        for bad in [r#"{"name": "x", "base64": "?"}"#, r#"{"name": "x"}"#, r#"{"name": "x", "base64": ""}"#, "7"] {
            assert!(serde_json::from_str::<Attachment<Heights>>(bad).is_err(), "{bad}");
        }
    }
}
