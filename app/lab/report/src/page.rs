//! Self-contained pages: filled-in templates with embedded figures. A page loads nothing from elsewhere.

use minijinja::{Environment, UndefinedBehavior, Value, context};

use crate::error::ReportError;
use crate::palette;
use crate::plot::Figure;

/// A page's own template, which extends `base.html.j2` and may import from `parts.html.j2`.
#[derive(Clone, Copy, Debug)]
pub struct Template {
    /// The name of its file; the extension `.html.j2` turns on HTML escaping.
    pub name: &'static str,
    /// Its text.
    pub text: &'static str,
}

/// Fills in a template and returns the page. The title and the plots' colours are added to `page`, the template's data.
///
/// # Errors
/// [`ReportError::Template`] if template and data do not match.
pub fn fill(template: Template, title: &str, page: Value) -> Result<String, ReportError> {
    let mut environment = Environment::new();
    environment.set_undefined_behavior(UndefinedBehavior::Strict);
    environment.set_trim_blocks(true);
    environment.set_lstrip_blocks(true);
    environment.add_template("base.html.j2", include_str!("templates/base.html.j2"))?;
    environment.add_template("parts.html.j2", include_str!("templates/parts.html.j2"))?;
    environment.add_template(template.name, template.text)?;
    let hex = |color: u32| format!("#{color:06X}");
    let colors = palette::colors().into_iter();
    let colors = colors.map(|(light, dark)| context! { light => hex(light), dark => hex(dark) });
    let common = context! { title => title, plot_colors => colors.collect::<Vec<_>>() };
    Ok(environment.get_template(template.name)?.render(context! { ..page, ..common })?)
}

/// Returns the figures in the form that the macro `plots` of `parts.html.j2` expects.
///
/// # Errors
/// [`ReportError::Plot`] if one cannot be drawn.
pub fn figures(figures: &[Figure]) -> Result<Vec<Value>, ReportError> {
    let figure = |figure: &Figure| {
        Ok(context! {
            id => &figure.id,
            title => &figure.title,
            caption => &figure.caption,
            svg => inline(&figure.svg()?),
        })
    };
    figures.iter().map(figure).collect()
}

/// Returns an SVG document in a form that can be embedded in a page: without a size and without the namespace.
fn inline(svg: &str) -> String {
    let start = svg.find("viewBox").unwrap_or(0);
    format!("<svg {}", svg[start..].replacen(" xmlns=\"http://www.w3.org/2000/svg\"", "", 1))
}
