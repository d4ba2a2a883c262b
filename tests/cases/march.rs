//! Rays: flush cuts, thin things, rays that take many steps.
