//! Keys of the lines of a header.

pub(super) const SYMBOL: &str = "SymbolName";

/// Keys of the other lines that a header may have.
pub(super) const KEYS: &[&str] = &[
    SYMBOL,
    "SymbolComment",
    "Data-Type",
    "SampleTime",
    "SampleTime[ms]",
    "VariableSize",
    "SymbolBased",
    "IndexGroup",
    "IndexOffset",
    "NetID",
    "NetId",
    "Port",
    "Offset",
    "ScaleFactor",
    "BitMask",
    "Unit",
    "Unit ScaleFactor",
    "Unit Offset",
];
