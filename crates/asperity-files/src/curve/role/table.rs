//! The quantities of a curve: key, unit, and the names that programs and people give them.

/// Makes the enum of the quantities from a table: key, unit in which a number without one is taken, unit of an example, and names,
/// [bare](super::bare); what "t" and "T" mean is decided elsewhere.
macro_rules! roles {
    ($($(#[$doc:meta])* $role:ident $key:literal [$si:literal, $example:literal] $names:literal;)*) => {
        /// What a column holds.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum Role {
            $($(#[$doc])* $role,)*
        }

        impl Role {
            /// All of them.
            pub const ALL: [Role; [$(Role::$role),*].len()] = [$(Role::$role),*];

            /// Its key in case files and on the command line.
            pub fn name(self) -> &'static str {
                match self {
                    $(Role::$role => $key,)*
                }
            }

            /// Unit in which a number without one is taken.
            pub(in crate::curve) fn si(self) -> &'static str {
                match self {
                    $(Role::$role => $si,)*
                }
            }

            /// A unit of an example.
            pub(in crate::curve) fn example(self) -> &'static str {
                match self {
                    $(Role::$role => $example,)*
                }
            }

            /// Names that mean it.
            pub(super) fn names(self) -> impl Iterator<Item = &'static str> {
                let names = match self {
                    $(Role::$role => $names,)*
                };
                names.split_whitespace()
            }
        }
    };
}

roles! {
    /// Time since the step.
    Time "time" ["s", "s"]
        "time testtime steptime elapsedtime totaltime reducedtime relaxationtime creeptime zeit messzeit prüfzeit
         versuchszeit temps durée timeonsample";
    /// Relaxation modulus.
    Modulus "modulus" ["Pa", "MPa"]
        "modulus e g et gt er gr erelax grelax erel grel relaxationmodulus relaxationmoduluset relaxationmodulusgt
         moduluset modulusgt shearmodulusgt stressrelaxationmodulus shearmodulus shearrelaxationmodulus tensilemodulus tensilerelaxationmodulus
         youngsmodulus young'smodulus emodulus gmodulus modul emodul gmodul relaxationsmodul relaxationsmodulet
         relaxationsmodulgt schubmodul zugmodul elastizitätsmodul module modulederelaxation moduledecisaillement moduled'young";
    /// Creep compliance.
    Compliance "compliance" ["1/Pa", "1/MPa"]
        "compliance d j dt jt dcreep jcreep creepcompliance creepcompliancejt creepcompliancedt
         compliancejt compliancedt shearcompliance
         tensilecompliance shearcreepcompliance tensilecreepcompliance nachgiebigkeit kriechnachgiebigkeit
         kriechnachgiebigkeitjt kriechnachgiebigkeitdt komplianz kriechkomplianz complaisance complaisancedefluage";
    /// Frequency, in Hz or rad/s.
    Frequency "frequency" ["Hz", "Hz"]
        "frequency freq f testfrequency reducedfrequency fred angularfrequency angularfreq angfrequency angfreq
         reducedangularfrequency angularfrequencyω kreisfrequenzω oscillationfrequency omegaat ωat atω fat atf omega ω
         w frequenz kreisfrequenz winkelfrequenz prüffrequenz messfrequenz fréquence frequence fréquenceangulaire pulsation";
    /// Storage modulus.
    Storage "storage" ["Pa", "MPa"]
        "storage e' g' m' ep gp estor gstor estorage gstorage eprime gprime storagemodulus storagemoduluse' storagemodulusg'
         modulus' e1 g1 ree* reg* reale* realg* dynamicstoragemodulus shearstoragemodulus tensilestoragemodulus
         bendingstoragemodulus shearmoduluselasticcomponent speichermodul speichermodule' speichermodulg'
         moduledeconservation moduledestockage";
    /// Loss modulus.
    Loss "loss" ["Pa", "MPa"]
        "loss e'' g'' m'' epp gpp eloss gloss edoubleprime gdoubleprime lossmodulus lossmoduluse'' lossmodulusg'' modulus'' e2
         g2 ime* img* image* imagg* dynamiclossmodulus shearlossmodulus tensilelossmodulus bendinglossmodulus
         shearmodulusviscouscomponent verlustmodul verlustmodule'' verlustmodulg'' moduledeperte moduledepertes";
    /// Loss factor E''/E', in place of the loss modulus.
    TanDelta "tan_delta" ["", "-"]
        "tandelta tand tanδ tan lossfactor losstangent tangensdelta tgdelta tgδ lossfactortandelta lossfactortanδ
         dampingfactor verlustfaktor verlustfaktortandelta verlustfaktortanδ facteurdeperte";
    /// Phase angle, in place of the loss factor.
    Phase "phase" ["rad", "deg"]
        "phase phaseangle phaseangledelta phaseangleδ phaseshift phaselag lossangle delta δ phasenwinkel
         phasenwinkeldelta phasenwinkelδ phasenverschiebung phasenverschiebungswinkel verlustwinkel angledephase déphasage
         angledeperte";
    /// Absolute value of the complex modulus, in place of the storage modulus.
    ComplexModulus "complex_modulus" ["Pa", "MPa"]
        "e* g* m* estar gstar ecomplex gcomplex complexmodulus complexmoduluse* abse* absg* absolutemodulus
         dynamischermodul komplexermodule* komplexermodulg* complexmodulusg* complexshearmodulus dynamicmodulus
         komplexermodul komplexerschubmodul modulecomplexe";
    /// Real part of the complex compliance.
    StorageCompliance "storage_compliance" ["1/Pa", "1/MPa"]
        "d' j' storagecompliance speichernachgiebigkeit speicherkomplianz";
    /// Imaginary part of the complex compliance.
    LossCompliance "loss_compliance" ["1/Pa", "1/MPa"]
        "d'' j'' losscompliance verlustnachgiebigkeit verlustkomplianz";
    /// Absolute value of the complex viscosity.
    ComplexViscosity "complex_viscosity" ["Pa s", "Pa s"]
        "η* n* eta* complexviscosity complexviscosityη* komplexeviskosität viscositécomplexe";
    /// Real part of the complex viscosity, loss modulus over angular frequency.
    RealViscosity "real_viscosity" ["Pa s", "Pa s"]
        "η' eta' realviscosity dynamicviscosity realpartofviscosity";
    /// Imaginary part of the complex viscosity, storage modulus over angular frequency.
    ImaginaryViscosity "imaginary_viscosity" ["Pa s", "Pa s"]
        "η'' eta'' imaginaryviscosity imaginarypartofviscosity";
    /// Temperature of the point.
    Temperature "temperature" ["K", "°C"]
        "temperature temp sampletemperature sampletemp ts tr tsample tprobe chambertemperature meantemperature
         temperatur probentemperatur messtemperatur température";
    /// Number or name of the sweep that the point belongs to.
    Set "set" ["", "-"]
        "set run sweep segment interval isotherm lauf messreihe intervall";
    /// Load of an indentation.
    Load "load" ["N", "mN"]
        "load force normalload normalforce w p f fn loadonsample kraft normalkraft prüfkraft standardkraft charge chargenormale";
    /// Depth of an indentation.
    Depth "depth" ["m", "um"]
        "depth indentation displacement indentationdepth approach h d displacementintosurface eindringtiefe tiefe weg
         traversenweg profondeur enfoncement";
    /// Way of a cantilever's base towards the sample.
    Height "height" ["m", "um"]
        "height z piezo zpiezo piezoheight heightmeasured measuredheight heightpiezo zsensor höhe hauteur";
    /// Deflection of a cantilever, a length or a voltage.
    Deflection "deflection" ["m", "nm"]
        "deflection defl verticaldeflection cantileverdeflection auslenkung déflexion";
}
