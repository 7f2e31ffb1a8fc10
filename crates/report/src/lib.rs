//! Tables and series to one self-contained HTML page with SVG plots
