//! Images as heights and textures.
