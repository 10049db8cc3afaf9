//! The GPUs that Mesa can compile for, and how its replacements of kernel drivers are made to present them.

use std::str::FromStr;

use anyhow::Context as _;

/// A family of compilers with a common output format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Compiler {
    /// Qualcomm's Adreno, with Mesa's driver freedreno.
    Ir3,
    /// Arm's Mali-G51 to G78 before Valhall, with Mesa's driver panfrost.
    Bifrost,
    /// Arm's Mali from G57 on, with Mesa's driver panfrost.
    Valhall,
}

impl Compiler {
    /// Returns the maximum number of waves in flight on one core or its shader processor. Mesa counts Mali's in halves.
    pub fn most_waves(self) -> u32 {
        match self {
            Self::Ir3 => 16,
            Self::Bifrost | Self::Valhall => 2,
        }
    }

    /// Returns the name of Mesa's driver.
    pub fn driver(self) -> &'static str {
        match self {
            Self::Ir3 => "freedreno",
            Self::Bifrost | Self::Valhall => "panfrost",
        }
    }
}

/// A GPU to compile for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Gpu {
    /// The name on the command line and in the table.
    pub name: &'static str,
    /// The name for people.
    pub title: &'static str,
    /// Mesa's compiler for this GPU.
    pub compiler: Compiler,
    /// The value of FD_GPU_ID or PAN_GPU_ID.
    pub id: &'static str,
    /// The change to the replaced kernel driver, if it does not know this GPU.
    pub replaces: Option<Replacement>,
}

/// An entry in the GPU table of Mesa's replacement of Adreno's kernel driver.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Entry {
    pub gpu: u32,
    pub chip: u64,
    /// Size of the tile memory in bytes.
    pub gmem: u32,
}

/// An entry that replaces the one of another GPU, whatever the size of that GPU's tile memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Replacement {
    pub old_gpu: u32,
    pub old_chip: u64,
    pub new: Entry,
}

impl Replacement {
    /// Changes the library in memory. Returns `None` if the library lacks the old entry.
    pub fn apply(&self, library: &mut [u8]) -> Option<()> {
        let Entry { gpu, chip, gmem } = self.new;
        // Layout in Mesa 26: 64-bit chip, GPU, tile memory.
        let key = |gpu: u32, chip: u64| [&chip.to_le_bytes()[..], &gpu.to_le_bytes()].concat();
        let old = key(self.old_gpu, self.old_chip);
        let at = library.windows(old.len()).position(|window| window == old)?;
        let new = [key(gpu, chip), gmem.to_le_bytes().to_vec()].concat();
        library.get_mut(at..at + new.len())?.copy_from_slice(&new);
        Some(())
    }
}

const QUEST_2: Replacement = Replacement {
    old_gpu: 618,
    old_chip: 0x0601_08ff,
    new: Entry { gpu: 650, chip: 0x0605_00ff, gmem: 0x12_0000 },
};
const QUEST_3: Replacement = Replacement {
    old_gpu: 730,
    old_chip: 0x0703_0001,
    new: Entry { gpu: 0, chip: 0x4305_0b00, gmem: 0x30_0000 },
};

const fn adreno(name: &'static str, title: &'static str, id: &'static str) -> Gpu {
    Gpu { name, title, compiler: Compiler::Ir3, id, replaces: None }
}

/// The GPUs that can be selected.
pub const GPUS: [Gpu; 11] = [
    Gpu { replaces: Some(QUEST_2), ..adreno("a650", "Adreno 650, Quest 2", "650") },
    Gpu { replaces: Some(QUEST_3), ..adreno("a740", "Adreno 740v3, Quest 3", "0") },
    adreno("a750", "Adreno 750, Steam Frame", "750"),
    Gpu { name: "g52", title: "Mali-G52", compiler: Compiler::Bifrost, id: "7212", replaces: None },
    Gpu { name: "g57", title: "Mali-G57", compiler: Compiler::Valhall, id: "9093", replaces: None },
    Gpu { name: "g610", title: "Mali-G610", compiler: Compiler::Valhall, id: "a867", replaces: None },
    adreno("a618", "Adreno 618", "618"),
    adreno("a660", "Adreno 660, Snapdragon 888", "660"),
    adreno("a730", "Adreno 730, Snapdragon 8 Gen 1", "730"),
    adreno("a740p", "Adreno 740 of phones, Snapdragon 8 Gen 2", "740"),
    adreno("a830", "Adreno 830, Snapdragon 8 Elite", "830"),
];

/// The number of these, from the first, that are in the committed table.
pub const IN_TABLE: usize = 6;

impl FromStr for Gpu {
    type Err = anyhow::Error;

    fn from_str(name: &str) -> anyhow::Result<Self> {
        let names = || GPUS.map(|gpu| gpu.name).join(", ");
        let found = GPUS.into_iter().find(|gpu| gpu.name == name);
        found.with_context(|| format!("no GPU is called {name}: choose of {}", names()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_entry_of_the_stand_in_is_replaced() {
        let words = |words: &[u32]| words.iter().flat_map(|word| word.to_le_bytes()).collect::<Vec<u8>>();
        let mut library = words(&[7, 0x0601_08ff, 0, 618, 5, 7]);
        QUEST_2.apply(&mut library).unwrap();
        assert_eq!(library, words(&[7, 0x0605_00ff, 0, 650, 0x12_0000, 7]));
        assert_eq!(QUEST_2.apply(&mut words(&[1, 2, 3])), None);
    }

    #[test]
    fn a_gpu_that_does_not_exist_is_refused_with_those_that_do() {
        assert_eq!("g57".parse::<Gpu>().unwrap().id, "9093");
        let error = "a100".parse::<Gpu>().unwrap_err().to_string();
        assert!(error.contains("a100") && error.contains("a650, a740"), "{error}");
    }
}
