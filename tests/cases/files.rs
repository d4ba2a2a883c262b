//! Files written: pictures, scenes, recovery.
