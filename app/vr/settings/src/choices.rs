//! Everything that is chosen by name, in settings files, on command lines and on pages.

use std::str::FromStr;

use serde::{Deserialize, Deserializer, Serialize, Serializer};
use toml::Value;

use crate::value::{Choice, SettingValue, find, named};

/// The most point lights that can light a view.
pub const MAX_POINT_LIGHTS: usize = 24;

/// The numbers of samples per pixel of a rendered view, as far as a driver has them.
pub const MSAA: [u32; 3] = [1, 2, 4];

/// A text that is not the name of any value of a type.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct ChoiceError(String);

/// Implements parsing and serde by the names of a type's values.
macro_rules! by_name {
    ($type:ident) => {
        impl FromStr for $type {
            type Err = ChoiceError;

            fn from_str(text: &str) -> Result<$type, ChoiceError> {
                find(&$type::ALL, $type::name, text).map_err(ChoiceError)
            }
        }

        impl Serialize for $type {
            fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                serializer.serialize_str(self.name())
            }
        }

        impl<'de> Deserialize<'de> for $type {
            fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<$type, D::Error> {
                String::deserialize(deserializer)?.parse().map_err(serde::de::Error::custom)
            }
        }
    };
}

/// Enumerations whose values have names, the same on the command line, in settings, in results and on the page. The
/// first line of a value's documentation is its help.
macro_rules! choices {
    ($(
        $(#[doc = $doc:literal])+
        $type:ident {
            $( #[doc = $help:literal] $(#[$default:ident])? $value:ident = $name:literal, )+
        }
    )+) => { $(
        $(#[doc = $doc])+
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum $type {
            $( #[doc = $help] $value, )+
        }

        impl $type {
            /// All values.
            pub const ALL: [$type; [$($name),+].len()] = [$($type::$value),+];

            /// The name on the command line, in settings and in results.
            pub fn name(self) -> &'static str {
                match self { $($type::$value => $name,)+ }
            }
        }

        $( choices!(@default $type $value $($default)?); )+

        by_name! { $type }

        named! {
            $type: &[$(Choice::new($name, $help)),+], |text: &str| find(&$type::ALL, $type::name, text);
        }
    )+ };
    (@default $type:ident $value:ident default) => {
        impl Default for $type {
            fn default() -> $type {
                $type::$value
            }
        }
    };
    (@default $type:ident $value:ident) => {};
}

choices! {
    /// A way to make both eyes of a frame. Methods that render both eyes come first.
    Method {
        /// Both eyes rendered, one after the other: the ground truth
        Conventional = "conventional",
        /// Both eyes in one set of draw calls, by instancing
        Instanced = "instanced",
        /// Both eyes in one set of draw calls, by GL_OVR_multiview2
        Multiview = "multiview",
        /// The far field rendered once for both eyes, the near field for each (Fink et al. 2019)
        Hybrid = "hybrid",
        /// The dominant eye's shading reprojected to the other eye's geometry; only disocclusions are shaded
        ShadingReprojection = "shading-reprojection",
        /// The dominant eye's image shown to both: the lower bound
        Mono = "mono",
        /// The dominant eye rendered, the other synthesized
        #[default]
        Synthesized = "yoro",
    }

    /// The pipeline that synthesizes the other eye.
    Pipeline {
        /// Fragment shaders that march along the source row
        #[default]
        Gather = "gather",
        /// Algorithms 1 to 3 of the paper
        Paper = "paper",
    }

    /// What becomes of pixels that the rendered eye does not show.
    HoleMethod {
        /// Filled from their background
        #[default]
        Filled = "filled",
        /// Rendered: opaque surfaces are drawn once more, for the other eye, in these pixels alone
        Rendered = "rendered",
    }

    /// How many of the display's frames are rendered.
    FrameRate {
        /// Every frame
        #[default]
        Full = "full",
        /// Every second one, where a headset's runtime makes the others
        Half = "half",
        /// Every second one while the full rate is missed
        Auto = "auto",
    }

    /// How the finished image follows the head after rendering.
    Timewarp {
        /// Not at all
        Off = "off",
        /// Turned by the head's rotation
        #[default]
        Rotation = "rotation",
        /// Moved by the head's rotation and translation, from the depth of both eyes
        Position = "position",
    }

    /// The display that shows the eyes.
    DisplayKind {
        /// A headset where there is an OpenXR runtime, else a Cardboard-compatible viewer
        #[default]
        Auto = "auto",
        /// A headset with an OpenXR runtime
        OpenXr = "openxr",
        /// A phone in a Cardboard-compatible viewer
        Cardboard = "cardboard",
    }

    /// Clock level of the processors, where applications can request one: on headsets by XR_EXT_performance_settings;
    /// on phones the two sustained levels are Android's sustained performance mode.
    Performance {
        /// Lowest clocks
        PowerSaving = "power-saving",
        /// Low clocks; the refresh rate may be missed
        SustainedLow = "sustained-low",
        /// Highest sustainable clocks
        #[default]
        SustainedHigh = "sustained-high",
        /// Highest clocks, for short bursts
        Boost = "boost",
    }
}

/// A stereo method, or one that is chosen by its cost.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum MethodChoice {
    /// One of conventional and yoro, which are measured alternately while in use: the cheaper one, or with holes=rendered the
    /// best that holds the display's rate.
    #[default]
    Auto,
    /// The given method.
    Named(Method),
}

impl MethodChoice {
    /// All values.
    pub const ALL: [MethodChoice; 1 + Method::ALL.len()] = {
        let mut all = [MethodChoice::Auto; 1 + Method::ALL.len()];
        let mut i = 0;
        while i < Method::ALL.len() {
            all[i + 1] = MethodChoice::Named(Method::ALL[i]);
            i += 1;
        }
        all
    };

    /// Returns the name in settings and on the page.
    pub fn name(self) -> &'static str {
        match self {
            MethodChoice::Auto => "auto",
            MethodChoice::Named(method) => method.name(),
        }
    }

    /// Returns the method that is used until something has been measured.
    pub fn first(self) -> Method {
        match self {
            MethodChoice::Auto => Method::Synthesized,
            MethodChoice::Named(method) => method,
        }
    }

    /// True if this choice can result in `method`.
    pub fn may_be(self, method: Method) -> bool {
        match self {
            MethodChoice::Auto => matches!(method, Method::Conventional | Method::Synthesized),
            MethodChoice::Named(named) => named == method,
        }
    }
}

impl From<Method> for MethodChoice {
    fn from(method: Method) -> MethodChoice {
        MethodChoice::Named(method)
    }
}

by_name! { MethodChoice }

named! {
    MethodChoice: &{
        let mut all = [Choice::new("auto", "The cheaper one of conventional and yoro, measured in turns; with rendered holes, the best in time"); MethodChoice::ALL.len()];
        let mut i = 0;
        while i < Method::ALL.len() {
            all[i + 1] = Method::CHOICES[i];
            i += 1;
        }
        all
    }, |text: &str| find(&MethodChoice::ALL, MethodChoice::name, text);
}

impl Method {
    /// True if the method shows pixels of one eye to the other, which requires eyes that look in the same direction
    /// ([`yoro::eyes::EyePair::synthesis_views`]).
    pub fn needs_aligned_eyes(self) -> bool {
        matches!(self, Method::Hybrid | Method::ShadingReprojection | Method::Mono | Method::Synthesized)
    }
}
