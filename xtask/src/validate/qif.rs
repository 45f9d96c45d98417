//! Measured characteristics in QIF, the Quality Information Framework.

use quick_xml::Reader;
use quick_xml::events::Event;
use std::collections::BTreeMap;

/// A characteristic of all parts that were measured.
#[derive(Debug, Default)]
pub struct Characteristic {
    pub nominal: Option<f64>,
    pub values: Vec<f64>,
}

impl Characteristic {
    /// The mean of the parts.
    pub fn mean(&self) -> f64 {
        self.values.iter().sum::<f64>() / self.values.len() as f64
    }
}

/// The characteristics of a document by name.
pub fn read(text: &str) -> Result<BTreeMap<String, Characteristic>, String> {
    let mut reader = Reader::from_str(text);
    // Of definitions, nominals, items and values: what each says, by its id.
    let mut names = BTreeMap::new();
    let mut nominals: BTreeMap<String, (String, Option<f64>)> = BTreeMap::new();
    let mut items = BTreeMap::new();
    let mut actuals = Vec::new();
    let (mut id, mut field) = (String::new(), String::new());
    let mut fields: BTreeMap<String, String> = BTreeMap::new();
    loop {
        match reader.read_event().map_err(|error| error.to_string())? {
            Event::Eof => break,
            Event::Start(start) => {
                field = start.local_name().as_ref().to_owned();
                if field.contains("Characteristic") {
                    let attribute = start.try_get_attribute("id").map_err(|error| error.to_string())?;
                    if let Some(value) = attribute {
                        id = value.value.into_owned();
                        fields.clear();
                    }
                }
            }
            Event::Text(words) => {
                let words = words.trim().to_owned();
                if !words.is_empty() {
                    fields.entry(field.clone()).or_insert(words);
                }
            }
            Event::End(end) => {
                let name = end.local_name().as_ref().to_owned();
                let of = |field: &str| fields.get(field).cloned();
                let number = |field: &str| of(field).and_then(|words| words.parse::<f64>().ok());
                if name.ends_with("CharacteristicDefinition") {
                    names.extend(of("Name").map(|found| (id.clone(), found)));
                } else if name.ends_with("CharacteristicNominal") {
                    let definition = of("CharacteristicDefinitionId");
                    nominals.extend(definition.map(|found| (id.clone(), (found, number("TargetValue")))));
                } else if name.ends_with("CharacteristicItem") {
                    items.extend(of("CharacteristicNominalId").map(|found| (id.clone(), found)));
                } else if name.ends_with("CharacteristicActual") {
                    actuals.extend(of("CharacteristicItemId").zip(number("Value")));
                }
            }
            _ => {}
        }
    }
    let mut found: BTreeMap<String, Characteristic> = BTreeMap::new();
    for (item, value) in actuals {
        let nominal = items.get(&item).and_then(|nominal| nominals.get(nominal));
        let Some((definition, target)) = nominal else { continue };
        let Some(name) = names.get(definition) else { continue };
        let entry = found.entry(name.clone()).or_default();
        entry.nominal = *target;
        entry.values.push(value);
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    #[test]
    fn values_have_the_name_of_their_definition() {
        let text = "<Q><DiameterCharacteristicDefinition id=\"1\"><Name>Bore</Name></DiameterCharacteristicDefinition>\
            <DiameterCharacteristicNominal id=\"2\"><CharacteristicDefinitionId>1</CharacteristicDefinitionId><TargetValue>4</TargetValue></DiameterCharacteristicNominal>\
            <DiameterCharacteristicItem id=\"3\"><CharacteristicNominalId>2</CharacteristicNominalId></DiameterCharacteristicItem>\
            <DiameterCharacteristicActual id=\"4\"><CharacteristicItemId>3</CharacteristicItemId><Value>4.1</Value></DiameterCharacteristicActual>\
            <DiameterCharacteristicActual id=\"5\"><CharacteristicItemId>3</CharacteristicItemId><Value>4.3</Value></DiameterCharacteristicActual></Q>";
        let found = super::read(text).unwrap();
        assert_eq!(found["Bore"].nominal, Some(4.0));
        assert!((found["Bore"].mean() - 4.2).abs() < 1e-12);
    }
}
