//! Input that went wrong in the window stands in `editor/`: `order`, `popups`, `fields`, `saving`, `locks`, `names`; what only a
//! window shows in `window.sh`.
