//! Cameras: narrow and wide pixels, near and far planes, large scenes with small parts.
