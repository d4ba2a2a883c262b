//! Faults of the window have their tests in `editor/`: `order`, `popups`, `fields`, `saving`, `locks`, `names`. Faults
//! that need a real window are in `window.sh`.
